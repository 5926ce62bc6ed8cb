// Slot facets: mirrors, of reflectance F.
#include "lib/microfacet.glsl"
#include "lib/warp.glsl"

bool counts(vec3 w) { return w.z > HORIZON; }

// What a facet sends to the end is the mean over the flight that leads to it, so that order 1 is exact: Torrance-Sparrow's, with
// correlated heights. Of two sharp facets in a row the walk draws the first and meets the second by chance, so a walk begins at
// either end, and what it finds counts by how likely it was to be found from this one (Veach and Guibas 1995, Eq. 14, of the outer
// facets alone): without it the largest of 2e5 weights for GGX of alpha = 0.1 is 700 and not 13.
vec3 walk(vec3 wo, vec3 wi) {
  bool swap = drawn().x < 0.5;
  vec3 w = swap ? -wi : -wo;
  vec3 end = swap ? wo : wi;
  vec3 weight = vec3(1.0), sum = vec3(0.0);
  float hidden = projected_area(-end, material.alpha);
  float back = 4.0 * (end.z + hidden);
  float depth = 0.0, outer = 0.0;  // density of the first direction drawn
  int last = last_order();
  for (int order = 1; order <= last; ++order) {
    float area = projected_area(-w, material.alpha);
    if (area <= CLEAR * w.z) break;
    float density = order < material.lowest ? 0.0 : D(end - w, material.alpha);
    if (density > 0.0) {
      float share = density / (4.0 * area) * passage(depth, w, area, end, hidden);
      if (order > 1) share *= 2.0 * outer / (outer + density / back);
      sum += weight * F(cos_facet(-w, end), material.eta, material.k) * share;
    }
    vec3 u = drawn();
    depth = flight(depth, w, area, u.xy);
    if (order == last || depth < 0.0) break;
    vec3 wm = sample_wm(-w, u.yz, material.alpha);
    weight *= F(clamp(dot(-w, wm), 0.0, 1.0), material.eta, material.k);
    if (order == 1) outer = D(wm, material.alpha) / (4.0 * area);
    w = mirror(-w, wm);
  }
  return sum;
}

// Chance of the cosine lobe, for light that met more than one facet; in 32nds, so that float32 subtracts it without rounding.
float broad() { return ceil(16.0 * max(material.alpha.x, material.alpha.y)) / 32.0; }

float pdf_lobes(vec3 wo, vec3 wi) {
  return mix(pdf_wi(wo, wi, D(wo + wi, material.alpha), material.alpha), INV_PI * wi.z, broad());
}

vec3 sample_lobes(vec3 wo, vec2 u) {
  float share = broad();
  if (u.x < share) return cosine_hemisphere(vec2(u.x / share, u.y));
  return sample_wi(wo, vec2((u.x - share) / (1.0 - share), u.y), material.alpha);
}
