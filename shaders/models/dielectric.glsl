// A rough interface between two dielectrics, whose facets reflect and refract. Walter et al. 2007, "Microfacet Models for Refraction
// through Rough Surfaces", Eqs. 20 and 21; their radiance is that of the viewer's side: a viewer in air sees light from below
// diluted by 1 / eta^2, and f(wo, wi) / n_o^2 = f(wi, wo) / n_i^2 with the index n of a direction's side. Directions below the
// horizon lie in the medium of index eta. Leaves out light that meets more than one facet.
#include "params.glsl"
#include "lib/common.glsl"
#include "lib/microfacet.glsl"
#include "lib/ndf_{ndf}.glsl"
#include "lib/sampling_{ndf}_caps.glsl"
#include "lib/smith_{ndf}_exact.glsl"
#include "lib/masking_{masking}.glsl"
#include "lib/random.glsl"
#include "lib/refraction.glsl"

// The index of the other side over that of w.
float eta_seen(vec3 w) {
  float eta = apart_from_one(material.eta);
  return w.z > 0.0 ? eta : 1.0 / eta;
}

float G2(vec3 wo, vec3 wi) {
  float Lambda_o = Lambda(upward(wo), material.alpha);
  float Lambda_i = Lambda(upward(wi), material.alpha);
  return wo.z * wi.z > 0.0 ? G2_reflected(Lambda_o, Lambda_i) : G2_transmitted(Lambda_o, Lambda_i);
}

// Of facets that refract wi to wo: T D cos cos / L^2, the same with wo and wi exchanged.
float passing(vec3 wo, vec3 wi) {
  float eta = apart_from_one(material.eta);
  vec3 sum = wo.z > 0.0 ? sum_refracted(wo, wi, eta) : sum_refracted(wi, wo, eta);
  vec3 wm = eta > 1.0 ? -sum : sum;
  float share = T_spread(wm, eta);
  return share > 0.0 ? share * D(wm, material.alpha) : 0.0;
}

vec3 f(vec3 wo, vec3 wi) {
  if (abs(wo.z) <= HORIZON || abs(wi.z) <= HORIZON) return vec3(0.0);
  float area = abs(wo.z * wi.z);
  if (wo.z * wi.z < 0.0) {
    float n = wo.z > 0.0 ? 1.0 : eta_seen(wi);
    return vec3(n * n * passing(wo, wi) * G2(wo, wi) / area);
  }
  vec3 o = upward(wo);
  vec3 i = upward(wi);
  return vec3(F_dielectric(cos_facet(o, i), eta_seen(wo)) * D(o + i, material.alpha) * G2(wo, wi) / (4.0 * area));
}

float pdf(vec3 wo, vec3 wi) {
  if (abs(wo.z) <= HORIZON || abs(wi.z) <= HORIZON) return 0.0;
  vec3 o = upward(wo);
  vec3 i = upward(wi);
  float area = visible_area(o, material.alpha);
  if (wo.z * wi.z < 0.0) {
    float n = wo.z > 0.0 ? eta_seen(wo) : 1.0;
    return n * n * passing(wo, wi) / area;
  }
  return F_dielectric(cos_facet(o, i), eta_seen(wo)) * D(o + i, material.alpha) / (4.0 * area);
}

// A visible facet, which reflects with the chance F: what is left of the weight is G2 / G1(wo), over eta^2 for what passes. A
// direction that ends on the wrong side of the surface is lost: it is put on the horizon.
vec3 sample_f(vec3 wo, vec2 u, out vec3 wi) {
  wi = vec3(1.0, 0.0, 0.0);
  if (abs(wo.z) <= HORIZON) return vec3(0.0);
  vec3 o = upward(wo);
  float eta = eta_seen(wo);
  vec3 wm = sample_wm(o, u, material.alpha);
  bool reflects = third(u) < F_dielectric(clamp(dot(o, wm), 0.0, 1.0), eta);
  vec3 w = reflects ? mirror(o, wm) : refracted(o, wm, eta);
  bool lost = reflects ? w.z <= HORIZON : w.z >= -HORIZON;
  wi = vec3(w.xy, lost ? 0.0 : wo.z > 0.0 ? w.z : -w.z);
  if (lost) return vec3(0.0);
  float share = visible_area(o, material.alpha) / o.z * G2(wo, wi);
  return vec3(reflects ? share : share / (eta * eta));
}
