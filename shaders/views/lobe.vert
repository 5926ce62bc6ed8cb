// A vertex of the lobe: the direction of a table's texel, as long as its value says.
#include "lib/srgb.glsl"

uniform sampler2D directions;  // wi, a row a ray
uniform sampler2D values;      // f there
uniform vec3 right;            // the camera's axes
uniform vec3 up;
uniform vec3 eye;
uniform vec2 center;  // where the origin lies, in units of the target's half size
uniform vec2 unit;    // a length of 1, in the same units
uniform float share;  // radius 1 over the largest value
uniform float decades;
out vec3 normal;
out float height;

#include "views/lobe_{quantity}.glsl"
#include "views/lobe_{radius}.glsl"

vec4 vertex(ivec2 at) {
  ivec2 count = textureSize(values, 0);
  ivec2 texel = ivec2(clamp(at.x, 0, count.x - 1), (at.y + count.y) % count.y);
  vec3 wi = texelFetch(directions, texel, 0).xyz;
  float r = radius(quantity(luminance(texelFetch(values, texel, 0).rgb), wi) * share, decades);
  return vec4(r * wi, r);
}

void main() {
  ivec2 count = textureSize(values, 0);
  ivec2 at = ivec2(gl_VertexID % count.x, gl_VertexID / count.x);
  int quarter = count.y / 4;
  bool pole = at.x == 0;  // all rays meet there: across it instead of around it
  vec3 along = vertex(at + ivec2(1, 0)).xyz - (pole ? vertex(ivec2(1, at.y + 2 * quarter)).xyz : vertex(at - ivec2(1, 0)).xyz);
  vec3 around = pole ? vertex(ivec2(1, at.y + quarter)).xyz - vertex(ivec2(1, at.y + 3 * quarter)).xyz
                     : vertex(at + ivec2(0, 1)).xyz - vertex(at - ivec2(0, 1)).xyz;
  vec4 here = vertex(at);
  normal = cross(along, around);
  float steepness = length(normal);
  normal = steepness > 0.0 ? normal / steepness : eye;
  height = here.w;
  gl_Position = vec4(center + unit * vec2(dot(right, here.xyz), dot(up, here.xyz)), -0.4 * dot(eye, here.xyz), 1.0);
}
