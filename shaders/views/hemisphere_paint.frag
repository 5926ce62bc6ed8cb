// Values over the disc, coloured by their share of the largest; magenta where one is no finite number.
#include "lib/colormap.glsl"
#include "views/lobe_{radius}.glsl"

uniform sampler2D values;
uniform float side;     // pixels along the side of one of the values
uniform vec2 size;      // of the picture, pixels
uniform vec2 middle;    // of the picture, on the disc
uniform float pixel;    // side of a pixel on the disc
uniform float share;    // 1 / largest value
uniform float decades;  // below it that a logarithmic scale shows
uniform vec3 paper;
out vec4 color;

void main() {
  float coverage = clamp((1.0 - length(middle + pixel * (gl_FragCoord.xy - 0.5 * size))) / pixel + 0.5, 0.0, 1.0);
  float value = texelFetch(values, ivec2(gl_FragCoord.xy / side), 0).r;
  bool wrong = isnan(value) || isinf(value);
  color = vec4(mix(paper, wrong ? vec3(1.0, 0.0, 1.0) : viridis(radius(value * share, decades)), coverage), 1.0);
}
