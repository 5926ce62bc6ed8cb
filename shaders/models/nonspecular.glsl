// Microfacets that are no mirrors, the lecture's "Non-Specular Microfacets":
// f = 1 / (cos theta_o cos theta_i) times the integral of D G f_mf (wo . wm)+ (wi . wm)+ over the facets' normals wm, where f_mf is
// the facet's own BRDF. Leaves out light that meets more than one facet. By quadrature: lib/facets.glsl says how well.
#include "params.glsl"
#include "lib/common.glsl"
#include "lib/microfacet.glsl"
#include "lib/gauss_{nodes}.glsl"
#include "lib/facets_{ndf}.glsl"
#include "lib/sampling_{ndf}_caps.glsl"
#include "lib/smith_{ndf}_{smith}.glsl"
#include "lib/shadowing_{shadowing}.glsl"
#include "lib/fresnel_{fresnel}.glsl"
#include "lib/facet_{facet}.glsl"

vec3 f(vec3 wo, vec3 wi) {
  if (wo.z <= HORIZON || wi.z <= HORIZON) return vec3(0.0);
  float G = G2(wo, wi, Lambda(wo, material.alpha), Lambda(wi, material.alpha));
  float seen = facets(wo, wi, material.alpha, facet_sharpness(material.kappa), NODE_SCALE, NODES);
  vec3 scale = facet_scale(cos_facet(wo, wi), material.albedo, material.eta, material.k, material.kappa);
  return scale * (G * seen / (wo.z * wi.z));
}

float pdf(vec3 wo, vec3 wi) {
  if (wo.z <= HORIZON || wi.z <= HORIZON) return 0.0;
  return facet_pdf(wo, wi, material.alpha, material.kappa);
}

vec3 sample_f(vec3 wo, vec2 u, out vec3 wi) {
  wi = vec3(0.0, 0.0, 1.0);
  if (wo.z <= HORIZON) return vec3(0.0);
  wi = facet_wi(wo, u, material.alpha, material.kappa);
  if (wi.z <= HORIZON) return vec3(0.0);
  return f(wo, wi) * (wi.z / pdf(wo, wi));
}
