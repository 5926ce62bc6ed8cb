// Slot diffuse: Oren and Nayar 1994, "Generalization of Lambert's Reflectance Model", the qualitative model: V-shaped grooves
// with Lambertian walls. With wo.xy . wi.xy = sin sin cos(dphi), its sin(max angle) tan(min angle) needs no angles.
// Leaves out interreflection in the grooves. Gains energy at grazing angles for a white facet: its albedo there is A + B/2,
// at most 1.0152 (sigma = 0.20).
#include "lib/common.glsl"

vec3 diffuse_f(vec3 wo, vec3 wi, vec3 albedo, float sigma, float r) {
  float s2 = sigma * sigma;
  float A = 1.0 - 0.5 * s2 / (s2 + 0.33);
  float B = 0.45 * s2 / (s2 + 0.09);
  return INV_PI * albedo * (A + B * max(dot(wo.xy, wi.xy), 0.0) / max(wo.z, wi.z));
}
