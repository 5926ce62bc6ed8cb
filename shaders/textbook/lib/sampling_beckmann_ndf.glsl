// Slot sampling: normals by D cos theta_m as printed, Walter et al. 2007, Eqs. 28 and 29: theta = atan(sqrt(-alpha^2 log(1 - u))),
// for alpha = 1, then stretched.
// In float32 errors of 1e-4 next to u = 0, by the log of Mesa.
#include "lib/common.glsl"
#include "textbook/facet.glsl"

vec3 sample_wi(vec3 wo, vec2 u, vec2 alpha) {
  float theta = atan(sqrt(-log(1.0 - u.x)));
  float phi = TWO_PI * u.y;
  vec3 wm = vec3(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
  return mirror(wo, normalize(vec3(alpha * wm.xy, wm.z)));
}
