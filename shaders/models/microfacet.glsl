// Microfacets that are mirrors: Torrance and Sparrow 1967; Cook and Torrance 1982; the form is Walter et al. 2007, Eq. 20:
// f = D G F / (4 cos theta_i cos theta_o). Leaves out light that meets more than one facet, so rough metals lose energy:
// up to 0.69 of it for GGX at alpha = 1, seen along the normal (its albedo is 1 - ln 2), and transmission.
#include "params.glsl"
#include "lib/common.glsl"
#include "lib/microfacet.glsl"
#include "lib/ndf_{ndf}.glsl"
#include "lib/smith_{ndf}_{smith}.glsl"
#include "lib/shadowing_{shadowing}.glsl"
#include "lib/fresnel_{fresnel}.glsl"

vec3 f(vec3 wo, vec3 wi) {
  if (wo.z <= HORIZON || wi.z <= HORIZON) return vec3(0.0);
  float G = G2(wo, wi, Lambda(wo, material.alpha), Lambda(wi, material.alpha));
  vec3 facet = F(cos_facet(wo, wi), material.eta, material.k);
  return facet * (D(wo + wi, material.alpha) * G / (4.0 * wo.z * wi.z));
}

// D_visible / (4 wo . wm): the wo . wm of D_visible and of the reflection's Jacobian cancel.
float pdf(vec3 wo, vec3 wi) {
  if (wo.z <= HORIZON || wi.z <= HORIZON) return 0.0;
  return D(wo + wi, material.alpha) / (4.0 * visible_area(wo, material.alpha));
}

// The weight is F G2 / G1: D cancels.
vec3 sample_f(vec3 wo, vec2 u, out vec3 wi) {
  wi = vec3(0.0, 0.0, 1.0);
  if (wo.z <= HORIZON) return vec3(0.0);
  wi = mirror(wo, sample_D_visible(wo, u, material.alpha));
  if (wi.z <= HORIZON) return vec3(0.0);
  float G = G2(wo, wi, Lambda(wo, material.alpha), Lambda(wi, material.alpha));
  return F(cos_facet(wo, wi), material.eta, material.k) * (G * visible_area(wo, material.alpha) / wo.z);
}
