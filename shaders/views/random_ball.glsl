// Slot body: random numbers of this pass for each meeting of the path with the surface. The first takes evenly spread points, the
// others hashes: multiples of the same steps would join their dimensions.
#include "lib/random.glsl"

uint meeting = 0u;

vec2 random(uint stream) {
  uvec2 pixel = uvec2(gl_FragCoord.xy);
  if (meeting == 0u) return random2(pixel, pass, stream);
  return unit_interval(pcg3d(uvec3(pixel.x + 65536u * pixel.y, pass, 4u * meeting + stream)).xy);
}
