// Slot sampling: normals by D cos theta_m as printed, Walter et al. 2007, Eqs. 35 and 36: theta = atan(alpha sqrt(u / (1 - u))),
// for alpha = 1, then stretched.
// In float32 errors of 2e-5, by the atan of Mesa.
#include "lib/common.glsl"
#include "textbook/facet.glsl"

vec3 sample_wi(vec3 wo, vec2 u, vec2 alpha) {
  float theta = atan(sqrt(u.x) / sqrt(1.0 - u.x));
  float phi = TWO_PI * u.y;
  vec3 wm = vec3(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
  return mirror(wo, normalize(vec3(alpha * wm.xy, wm.z)));
}
