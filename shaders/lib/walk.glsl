// Steps of a random walk over Smith's microsurface. Heitz, Hanika, d'Eon and Dachsbacher 2016, "Multiple-Scattering Microfacet
// BSDFs with the Smith Model". Heights enter only by their distribution C1, and C1 only as depth = -log(C1), 0 above all facets:
// in it flights are exponential, as in a volume (Dupuy, Heitz and d'Eon 2016, "Additional Progress Towards the Unification of
// Microfacet and Microflake Theories"), and light that leaves along w is not met by a facet with probability exp(-depth Lambda(w)).
//
// `area` is that of the facets visible from -w, projected along w: |w.z Lambda(w)| for a ray w that goes up or down.
#include "lib/transcendental.glsl"

// (1 - exp(-x)) / x for x >= 0, by its series where the difference would cancel.
float mean_exp(float x) {
  return x < 0.1 ? 1.0 - x / 2.0 * (1.0 - x / 3.0 * (1.0 - x / 4.0)) : (1.0 - exp_precise(-x)) / x;
}

// Depth at which a ray w that begins at `depth` meets a facet; below 0 if it leaves. u.x is in [0, 1).
float flight(float depth, vec3 w, float area, vec2 u) { return depth + log_precise(1.0 - u.x) * w.z / area; }

// Probability that a ray w that begins at `depth` meets a facet.
float meets(float depth, vec3 w, float area) {
  if (w.z <= 0.0) return 1.0;
  float x = depth * area / w.z;
  return x < 1.0 ? x * mean_exp(x) : 1.0 - exp_precise(-x);
}

// Mean over the flights of a ray w that begins at `depth` of the probability that it meets a facet and that what goes on from there
// along wi, wi.z > 0, meets none; over wi.z. `hidden` is wi.z Lambda(wi). For depth = 0 it is G2 / (G1(wo) wi.z), wo = -w.
float passage(float depth, vec3 w, float area, vec3 wi, float hidden) {
  float difference = area * wi.z - w.z * hidden;
  float leave = hidden / wi.z;
  if (w.z <= 0.0) return exp_precise(-depth * leave) * area / difference;
  if (depth == 0.0) return 0.0;
  float meet = area / w.z;
  float x = abs(difference) / wi.z * depth / w.z;
  float lesser = exp_precise(-depth * min(leave, meet));
  return x < 1.0 ? lesser * meet * (depth / wi.z) * mean_exp(x) : lesser * (1.0 - exp_precise(-x)) * area / abs(difference);
}

// Depth of the same height below the surface, where it is measured from the lowest facet up: -log(1 - C1).
float depth_below(float depth) {
  float C1 = exp_precise(-depth);
  if (C1 < 0.1) return C1 * (1.0 + C1 * (1.0 / 2.0 + C1 * (1.0 / 3.0 + C1 * (1.0 / 4.0 + C1 * (1.0 / 5.0 + C1 / 6.0)))));
  return -log_precise(depth * mean_exp(depth));
}
