// Microfacets that are mirrors: Torrance and Sparrow 1967; Cook and Torrance 1982; the form is Walter et al. 2007, Eq. 20:
// f = D G F / (4 cos theta_i cos theta_o). Leaves out transmission, and light that meets more than one facet, so rough metals lose
// energy: up to 0.69 of it for GGX at alpha = 1, seen along the normal (its albedo is 1 - ln 2). The slot energy puts it back.
#include "params.glsl"
#include "lib/common.glsl"
#include "lib/microfacet.glsl"
#include "lib/ndf_{ndf}.glsl"
#include "lib/sampling_{ndf}_{sampling}.glsl"
#include "lib/smith_{ndf}_{smith}.glsl"
#include "lib/shadowing_{shadowing}.glsl"
#include "lib/fresnel_{fresnel}.glsl"
#include "models/microfacet_{energy}.glsl"

vec3 f(vec3 wo, vec3 wi) {
  if (wo.z <= HORIZON || wi.z <= HORIZON) return vec3(0.0);
  float G = G2(wo, wi, Lambda(wo, material.alpha), Lambda(wi, material.alpha));
  vec3 facet = F(cos_facet(wo, wi), material.eta, material.k);
  return energy_f(facet * (D(wo + wi, material.alpha) * G / (4.0 * wo.z * wi.z)), wo, wi);
}

float pdf(vec3 wo, vec3 wi) {
  if (wo.z <= HORIZON || wi.z <= HORIZON) return 0.0;
  return energy_pdf(pdf_wi(wo, wi, D(wo + wi, material.alpha), material.alpha), wo, wi);
}

// The weight of single scattering is F G2 D / (4 pdf wo.z), by weight_wi, where most samplers cancel D: for visible normals it is F G2 / G1.
vec3 sample_f(vec3 wo, vec2 u, out vec3 wi) {
  wi = vec3(0.0, 0.0, 1.0);
  if (wo.z <= HORIZON) return vec3(0.0);
  wi = energy_wi(wo, u);
  if (wi.z <= HORIZON) return vec3(0.0);
  float G = G2(wo, wi, Lambda(wo, material.alpha), Lambda(wi, material.alpha));
  float weight = weight_wi(wo, wi, D(wo + wi, material.alpha), material.alpha);
  return energy_weight(F(cos_facet(wo, wi), material.eta, material.k) * (G * weight / wo.z), wo, wi);
}
