// Slot sampling: normals by D cos theta_m. Walter et al. 2007, Eqs. 28 and 29, as slopes, stretched by alpha.
#include "lib/common.glsl"
#include "lib/sampling_facet.glsl"
#include "lib/transcendental.glsl"

vec3 sample_wi(vec3 wo, vec2 u, vec2 alpha) {
  float phi = TWO_PI * u.y;
  float slope = sqrt(-log_precise(1.0 - u.x));
  return mirror(wo, normalize(vec3(alpha * (slope * vec2(cos(phi), sin(phi))), 1.0)));
}
