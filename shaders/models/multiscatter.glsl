// Facets that light meets many times: a random walk over Smith's microsurface. Heitz, Hanika, d'Eon and Dachsbacher 2016,
// "Multiple-Scattering Microfacet BSDFs with the Smith Model". f is an unbiased estimate by one walk from wo, at each of whose facets
// what goes on to wi is added up, in orders of scattering. Leaves out that heights and slopes of neighbouring facets go together, and
// orders above MOST: less than 1e-7 of the energy where most is left, for white diffuse facets of alpha = 1.
#include "params.glsl"
#include "lib/common.glsl"
#include "lib/random.glsl"
#include "lib/walk.glsl"
#include "lib/ndf_{ndf}.glsl"
#include "lib/walk_{ndf}.glsl"
#include "lib/sampling_{ndf}_caps.glsl"
#include "lib/fresnel_{fresnel}.glsl"

const int MOST = 64;
const float CLEAR = 1e-14;  // a Lambda below this: no facet lies ahead

int last_order() { return min(material.lowest + material.orders - 1, MOST); }

// All files define these: whether f may be other than 0 for a direction, f by one walk, and a sampler of directions with its density.
#include "models/multiscatter_{facets}.glsl"

vec3 f(vec3 wo, vec3 wi) {
  if (!counts(wo) || !counts(wi)) return vec3(0.0);
  return walk(wo, wi);
}

float pdf(vec3 wo, vec3 wi) {
  if (!counts(wo) || !counts(wi)) return 0.0;
  return pdf_lobes(wo, wi);
}

vec3 sample_f(vec3 wo, vec2 u, out vec3 wi) {
  wi = vec3(1.0, 0.0, 0.0);
  if (!counts(wo)) return vec3(0.0);
  wi = sample_lobes(wo, u);
  if (!counts(wi)) return vec3(0.0);
  return f(wo, wi) * (abs(wi.z) / max(pdf(wo, wi), 1e-37));
}
