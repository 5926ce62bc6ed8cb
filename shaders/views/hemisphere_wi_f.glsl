#include "lib/srgb.glsl"

float quantity(vec3 wo, vec3 wi) {
  seed_random(pass);
  return luminance(f(wo, wi));
}
