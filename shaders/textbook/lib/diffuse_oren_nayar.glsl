// Slot diffuse: Oren and Nayar 1994, the qualitative model as printed, in angles.
// In float32 errors of 5e-4, by the acos of Mesa, and factors below 0 where both directions graze.
#include "lib/common.glsl"

vec3 diffuse_f(vec3 wo, vec3 wi, vec3 albedo, float sigma, float r) {
  float s2 = sigma * sigma;
  float A = 1.0 - 0.5 * s2 / (s2 + 0.33);
  float B = 0.45 * s2 / (s2 + 0.09);
  float theta_o = acos(wo.z);
  float theta_i = acos(wi.z);
  float cos_phi = dot(normalize(wo.xy), normalize(wi.xy));
  return INV_PI * albedo * (A + B * max(cos_phi, 0.0) * sin(max(theta_o, theta_i)) * tan(min(theta_o, theta_i)));
}
