// Slot facet: f_mf is a lobe about the facet's mirror direction R(wm, wo), von Mises and Fisher's density of sharpness kappa, times
// Fresnel's reflectance F(c), over c = |wo + wi| / 2, the cosine at a facet that would mirror wo to wi:
//   f_mf = F(c) / c kappa / (2 pi (1 - exp(-2 kappa))) exp(kappa (wi . R - 1)).
// Over c and not over wi . wm as the lecture's delta: where wi = R both are the same, and this f_mf is reciprocal. As kappa grows
// it becomes F delta(wi - R) / (wi . wm), and f that of Torrance and Sparrow; without F the limit is D G / (4 cos cos).
// Leaves out the light that the lobe sends below the facet: seen along its normal a facet reflects 0.46 of the light at kappa = 1,
// 0.92 at 10 and 0.992 at 100; at no angle more than 1.
#include "lib/common.glsl"
#include "lib/transcendental.glsl"
#include "lib/warp.glsl"

// Whoever includes this has these: of the slots ndf, sampling and fresnel.
float D(vec3 wm, vec2 alpha);
vec3 sample_wi(vec3 wo, vec2 u, vec2 alpha);
float pdf_wi(vec3 wo, vec3 wi, float density, vec2 alpha);
vec3 F(float c, vec3 eta, vec3 k);

// The share of the directions that are drawn by the cosine, so that no weight is large where the lobe is thin.
const float EVEN = 0.25;

float facet_sharpness(float kappa) { return kappa; }

vec3 facet_scale(float c, vec3 albedo, vec3 eta, vec3 k, float kappa) {
  return F(c, eta, k) * (0.5 * INV_PI * kappa / ((1.0 - exp_precise(-2.0 * kappa)) * c));
}

// The scale of the half vectors' slopes: that of the facets, and of the lobe, whose density over normals is a Gaussian of variance
// 1 / (4 kappa).
vec2 blurred(vec2 alpha, float kappa) { return sqrt(alpha * alpha + 0.5 / kappa); }

vec3 facet_wi(vec3 wo, vec2 u, vec2 alpha, float kappa) {
  if (u.x < EVEN) return cosine_hemisphere(vec2(u.x / EVEN, u.y));
  return sample_wi(wo, vec2((u.x - EVEN) / (1.0 - EVEN), u.y), blurred(alpha, kappa));
}

float facet_pdf(vec3 wo, vec3 wi, vec2 alpha, float kappa) {
  vec2 wider = blurred(alpha, kappa);
  return mix(pdf_wi(wo, wi, D(wo + wi, wider), wider), INV_PI * wi.z, EVEN);
}
