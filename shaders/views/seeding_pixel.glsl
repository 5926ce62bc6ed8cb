// Slot seeding: of a model that draws numbers of its own, for which each pixel and pass begins with another state.
#include "lib/random.glsl"

void seed_random(uint pass) { random_state = uvec3(uvec2(gl_FragCoord.xy), ~pass); }

// The mean of several estimates.
vec3 mean_f(vec3 wo, vec3 wi, int walks) {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < walks; ++i) sum += f(wo, wi);
  return sum / float(walks);
}
