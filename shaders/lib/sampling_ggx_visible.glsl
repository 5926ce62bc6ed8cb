// Slot sampling: visible normals, D_visible = D (wo . wm)+ / visible_area. Heitz 2018, "Sampling the GGX Distribution of Visible
// Normals", Listing 1, rearranged so that nothing cancels near the rim of the disc, where float32 would lose the normal's height:
// there its slope would err by 3e-8 over alpha and the height.
#include "lib/common.glsl"
#include "lib/ndf_ggx.glsl"

vec3 sample_wm(vec3 wo, vec2 u, vec2 alpha) {
  vec3 v = normalize(vec3(alpha * wo.xy, wo.z));
  float sin_o = length(v.xy);
  vec2 azimuth = sin_o > 0.0 ? v.xy / sin_o : vec2(1.0, 0.0);
  float s = 0.5 * (1.0 + v.z);
  float phi = TWO_PI * u.y;
  vec2 p = sqrt(u.x) * vec2(cos(phi), sin(phi));  // on the disc, on a chord of half length w that v projects on itself
  float w = sqrt(1.0 - u.x + p.y * p.y);
  float far = w + abs(p.y);
  float near = (1.0 - u.x) / far;
  float up = p.y > 0.0 ? near : far;  // to the chord's ends: w - p.y and w + p.y
  float down = p.y > 0.0 ? far : near;
  float y = w - s * up;  // the chord shrunk to the visible part
  float z = sqrt(up * (0.5 * sin_o * sin_o * w + s * s * down));  // sqrt(w^2 - y^2)
  float height = y < 0.0 ? s * down * (w * v.z - y) / (z * v.z - y * sin_o) : z * v.z + y * sin_o;
  vec2 xy = (z * sin_o - y * v.z) * azimuth + p.x * vec2(-azimuth.y, azimuth.x);
  return normalize(vec3(alpha * xy, height));
}

vec3 sample_wi(vec3 wo, vec2 u, vec2 alpha) { return mirror(wo, sample_wm(wo, u, alpha)); }

float pdf_wi(vec3 wo, vec3 wi, float density, vec2 alpha) { return density / (4.0 * visible_area(wo, alpha)); }

float weight_wi(vec3 wo, vec3 wi, float density, vec2 alpha) { return visible_area(wo, alpha); }
