// Slot diffuse: EON, the energy-preserving Oren-Nayar model. Portsmouth, Kutz and Hill 2025, "EON: A Practical Energy-Preserving
// Rough Diffuse BRDF", Listing 1 with the exact albedo. Light that meets one facet follows Fujii's Oren-Nayar (FON), of
// roughness r in [0, 1], a shape and not an angle; the share 1 - E that FON loses comes back as a reciprocal lobe of multiple
// scattering. The albedo of white facets is 1 at every angle and every r.
// Leaves out where light goes that meets several facets: its lobe is a product of one function of each cosine.
#include "lib/common.glsl"
#include "lib/transcendental.glsl"

const float FON_ONE = 0.2877934092108062;   // 1/2 - 2 / (3 pi): FON's A is 1 / (1 + FON_ONE r)
const float FON_TWO = 0.07248821245692394;  // 2/3 - 28 / (15 pi): its mean albedo is A (1 + FON_TWO r)

// What FON loses of white light along w, (1 - E) / (A r), for a cosine c in (0, 1]. E = A (1 + r G(c) / pi) and G(0) is
// pi FON_ONE, so 1 - E cancels at the horizon; this is FON_ONE - G / pi with all its terms in proportion to c.
float fon_loss(vec3 w) {
  float c = w.z, s = length(w.xy);
  float flat_part = 0.904129660128230 * c * c / (1.0 + s);  // (pi / 2 - 2 / 3)(1 - s)
  float slope = atan2_precise(c, s) + c * (s - 2.0 / 3.0 * (1.0 + s + s * s) / (1.0 + s));
  return INV_PI * (flat_part + s * slope);
}

vec3 diffuse_f(vec3 wo, vec3 wi, vec3 albedo, float sigma, float r) {
  float A = 1.0 / (1.0 + FON_ONE * r);
  float mean = A * (1.0 + FON_TWO * r);
  float s = dot(wo.xy, wi.xy);  // sin sin cos(dphi)
  vec3 h = wo + wi;
  // below 0, where 1 + r s may cancel: 1 + s = (|h.xy|^2 + wo.z^2 + wi.z^2) / 2
  float single = s > 0.0 ? 1.0 + r * s / max(wo.z, wi.z)
                         : (1.0 - r) + 0.5 * r * (dot(h.xy, h.xy) + wo.z * wo.z + wi.z * wi.z);
  float lobe = r * fon_loss(wo) * fon_loss(wi) / (FON_ONE - FON_TWO);
  vec3 several = albedo * mean / (1.0 - albedo * (1.0 - mean));
  return INV_PI * A * albedo * (single + several * lobe);
}
