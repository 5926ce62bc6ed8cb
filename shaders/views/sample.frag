// One direction drawn a pixel, for a viewer and random numbers from its place: what sampling a material costs.
#include "models/{model}.glsl"
#include "views/seeding_{seeding}.glsl"

uniform vec2 size;
out vec4 color;

void main() {
  seed_random(0u);
  vec2 u = gl_FragCoord.xy / size;
  vec3 wi;
  vec3 weight = sample_f(normalize(vec3(u.y - 0.5, u.x - 0.5, 0.7)), u, wi);
  color = vec4(weight, wi.z);
}
