// The environment behind the sphere, seen in perspective although the sphere is not: two radii off the centre lie 45 degrees
// off the axis.
#include "lib/environment.glsl"

uniform sampler2D map;
uniform mat3 turn;
uniform float gain;
uniform vec2 center;
uniform float radius;
out vec4 color;

void main() {
  vec3 w = normalize(vec3(0.5 * (gl_FragCoord.xy - center) / radius, -1.0));
  color = vec4(gain * environment_radiance(map, turn * w), 1.0);
}
