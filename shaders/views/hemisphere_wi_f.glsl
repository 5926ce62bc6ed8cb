#include "lib/srgb.glsl"

float quantity(vec3 wo, vec3 wi) {
  seed_random(0u);
  return luminance(mean_f(wo, wi, walks));
}
