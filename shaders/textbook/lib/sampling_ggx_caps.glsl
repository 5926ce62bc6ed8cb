// Slot sampling: visible normals as printed, Dupuy and Benyoub 2023, Listing 3.
// In float32 c + v cancels where facets are seen from the side: a reflected direction may be off by its whole length, 2.
#include "lib/common.glsl"
#include "lib/ndf_ggx.glsl"

vec3 sample_wm(vec3 wo, vec2 u, vec2 alpha) {
  vec3 v = normalize(vec3(alpha * wo.xy, wo.z));
  float phi = TWO_PI * u.x;
  float z = (1.0 - u.y) * (1.0 + v.z) - v.z;
  float r = sqrt(clamp(1.0 - z * z, 0.0, 1.0));
  vec3 h = vec3(r * cos(phi), r * sin(phi), z) + v;
  return normalize(vec3(alpha * h.xy, h.z));
}

vec3 sample_wi(vec3 wo, vec2 u, vec2 alpha) { return mirror(wo, sample_wm(wo, u, alpha)); }

float pdf_wi(vec3 wo, vec3 wi, float density, vec2 alpha) { return density / (4.0 * visible_area(wo, alpha)); }

float weight_wi(vec3 wo, vec3 wi, float density, vec2 alpha) { return visible_area(wo, alpha); }
