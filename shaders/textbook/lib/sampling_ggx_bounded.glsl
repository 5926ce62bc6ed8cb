// Slot sampling: a bounded cap of visible normals as printed, Eto and Tokuyoshi 2023, Listing 1.
// In float32 1 - z^2 cancels where the cap is small.
#include "lib/common.glsl"
#include "lib/ndf_ggx.glsl"

float bounded_k(vec3 wo, vec2 alpha) {
  float a = clamp(min(alpha.x, alpha.y), 0.0, 1.0);
  float s = 1.0 + length(wo.xy);
  return (1.0 - a * a) * s * s / (s * s + a * a * wo.z * wo.z);
}

vec3 sample_wi(vec3 wo, vec2 u, vec2 alpha) {
  vec3 v = normalize(vec3(alpha * wo.xy, wo.z));
  float phi = TWO_PI * u.x;
  float b = bounded_k(wo, alpha) * v.z;
  float z = (1.0 - u.y) * (1.0 + b) - b;
  float r = sqrt(clamp(1.0 - z * z, 0.0, 1.0));
  vec3 h = vec3(r * cos(phi), r * sin(phi), z) + v;
  return mirror(wo, normalize(vec3(alpha * h.xy, h.z)));
}

float weight_wi(vec3 wo, vec3 wi, float density, vec2 alpha) {
  return (bounded_k(wo, alpha) * wo.z + length(vec3(alpha * wo.xy, wo.z))) / 2.0;
}

float pdf_wi(vec3 wo, vec3 wi, float density, vec2 alpha) { return density / (4.0 * weight_wi(wo, wi, density, alpha)); }
