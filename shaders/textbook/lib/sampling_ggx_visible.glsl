// Slot sampling: visible normals as printed, Heitz 2018, "Sampling the GGX Distribution of Visible Normals", Listing 1.
// In float32 errors of 3e-5, and of more next to the rim of the disc.
#include "lib/common.glsl"
#include "lib/ndf_ggx.glsl"

vec3 sample_wm(vec3 wo, vec2 u, vec2 alpha) {
  vec3 Vh = normalize(vec3(alpha * wo.xy, wo.z));
  float lensq = Vh.x * Vh.x + Vh.y * Vh.y;
  vec3 T1 = lensq > 0.0 ? vec3(-Vh.y, Vh.x, 0.0) * inversesqrt(lensq) : vec3(0.0, 1.0, 0.0);
  vec3 T2 = cross(Vh, T1);
  float r = sqrt(u.x);
  float phi = TWO_PI * u.y;
  float t1 = r * cos(phi);
  float t2 = r * sin(phi);
  float s = 0.5 * (1.0 + Vh.z);
  t2 = (1.0 - s) * sqrt(1.0 - t1 * t1) + s * t2;
  vec3 Nh = t1 * T1 + t2 * T2 + sqrt(max(0.0, 1.0 - t1 * t1 - t2 * t2)) * Vh;
  return normalize(vec3(alpha * Nh.xy, max(0.0, Nh.z)));
}

vec3 sample_wi(vec3 wo, vec2 u, vec2 alpha) { return mirror(wo, sample_wm(wo, u, alpha)); }

float pdf_wi(vec3 wo, vec3 wi, float density, vec2 alpha) { return density / (4.0 * visible_area(wo, alpha)); }

float weight_wi(vec3 wo, vec3 wi, float density, vec2 alpha) { return visible_area(wo, alpha); }
