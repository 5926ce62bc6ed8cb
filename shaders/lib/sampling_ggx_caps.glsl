// Slot sampling: visible normals, D_visible = D (wo . wm)+ / visible_area. Dupuy and Benyoub 2023, "Sampling Visible GGX Normals
// with Spherical Caps", Listing 3. q = 1 - z of the cap's point: sqrt(q (2 - q)) errs by 1.1e-7 where sqrt(1 - z z) does by
// 2.5e-8 / q.
#include "lib/common.glsl"
#include "lib/ndf_ggx.glsl"

vec3 sample_wi(vec3 wo, vec2 u, vec2 alpha) {
  vec3 v = normalize(vec3(alpha * wo.xy, wo.z));
  float phi = TWO_PI * u.x;
  float q = u.y * (1.0 + v.z);
  vec2 xy = sqrt(q * (2.0 - q)) * vec2(cos(phi), sin(phi)) + v.xy;
  return mirror(wo, normalize(vec3(alpha * xy, (1.0 - u.y) * (1.0 + v.z))));
}

float pdf_wi(vec3 wo, vec3 wi, float density, vec2 alpha) { return density / (4.0 * visible_area(wo, alpha)); }

float weight_wi(vec3 wo, vec3 wi, float density, vec2 alpha) { return visible_area(wo, alpha); }
