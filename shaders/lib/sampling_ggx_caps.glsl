// Slot sampling: visible normals, D_visible = D (wo . wm)+ / visible_area. Dupuy and Benyoub 2023, "Sampling Visible GGX Normals
// with Spherical Caps", Listing 3.
#include "lib/caps.glsl"
#include "lib/common.glsl"
#include "lib/ndf_ggx.glsl"

// A visible normal; wo may lie below the horizon.
vec3 sample_wm(vec3 wo, vec2 u, vec2 alpha) {
  vec3 v = normalize(vec3(alpha * wo.xy, wo.z));
  vec3 sum = sum_with_cap(v, u, 0.0);
  return normalize(vec3(alpha * sum.xy, sum.z));
}

vec3 sample_wi(vec3 wo, vec2 u, vec2 alpha) { return mirror(wo, sample_wm(wo, u, alpha)); }

float pdf_wi(vec3 wo, vec3 wi, float density, vec2 alpha) { return density / (4.0 * visible_area(wo, alpha)); }

float weight_wi(vec3 wo, vec3 wi, float density, vec2 alpha) { return visible_area(wo, alpha); }
