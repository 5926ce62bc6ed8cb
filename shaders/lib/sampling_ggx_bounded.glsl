// Slot sampling: visible normals less those that reflect below the horizon, as far as a smaller cap leaves them out. Eto and
// Tokuyoshi 2023, "Bounded VNDF Sampling for Smith-GGX Reflections", Eq. 5. For wo above the horizon.
#include "lib/caps.glsl"
#include "lib/common.glsl"
#include "lib/ndf_ggx.glsl"

// 1 - k of Eq. 5, by which the cap's lower bound, -v.z, is scaled: as a product, for k -> 1 as alpha -> 0.
float cut_of_cap(vec3 wo, vec2 alpha) {
  float a = min(alpha.x, alpha.y);
  float s = 1.0 + length(wo.xy);
  return a * a * (s * s + wo.z * wo.z) / (s * s + a * a * wo.z * wo.z);
}

vec3 sample_wi(vec3 wo, vec2 u, vec2 alpha) {
  vec3 v = normalize(vec3(alpha * wo.xy, wo.z));
  vec3 sum = sum_with_cap(v, u, cut_of_cap(wo, alpha));
  return mirror(wo, normalize(vec3(alpha * sum.xy, sum.z)));
}

float weight_wi(vec3 wo, vec3 wi, float density, vec2 alpha) {
  return visible_area(wo, alpha) - 0.5 * cut_of_cap(wo, alpha) * wo.z;
}

float pdf_wi(vec3 wo, vec3 wi, float density, vec2 alpha) { return density / (4.0 * weight_wi(wo, wi, density, alpha)); }
