// Slot diffuse: Lambertian facets with Gaussian slopes that meet light once, the lecture's integral as in the model nonspecular, with
// the height-correlated G of Smith's heights (Heitz 2014, Eq. 99). sigma is the standard deviation of a facet's angle of slope as in
// oren_nayar: Beckmann's alpha is sqrt(2) tan sigma. By 12 x 12 nodes: 4e-4 of f, 2e-3 at most. Leaves out light that meets several
// facets, so white facets lose 0.010 of the light at sigma = 0.1, 0.08 at 0.3, 0.18 at 0.5 and 0.52 at 1, seen along the normal.
#include "lib/common.glsl"
#include "lib/gauss_12.glsl"
#include "lib/facets_beckmann.glsl"

vec3 diffuse_f(vec3 wo, vec3 wi, vec3 albedo, float sigma, float r) {
  vec2 alpha = vec2(max(1.41421356 * sin(sigma) / cos(sigma), 1e-4));
  float seen = facets(wo, wi, alpha, 0.0, NODE_SCALE, NODES);
  // G / (cos cos), G = cos cos / (cos_i area_o + cos_o area_i - cos cos) with area = cos (1 + Lambda)
  float area_o = visible_area(wo, alpha), area_i = visible_area(wi, alpha);
  return INV_PI * albedo * (seen / (wi.z * area_o + wo.z * (area_i - wi.z)));
}
