// Slot sampling: normals by D cos theta_m. Walter et al. 2007, Eqs. 35 and 36, as slopes, stretched by alpha.
#include "lib/common.glsl"
#include "lib/sampling_facet.glsl"

vec3 sample_wi(vec3 wo, vec2 u, vec2 alpha) {
  float phi = TWO_PI * u.y;
  return mirror(wo, normalize(vec3(alpha * (sqrt(u.x) * vec2(cos(phi), sin(phi))), sqrt(1.0 - u.x))));
}
