// Torrance-Sparrow as the lecture prints it: f = D G F / (4 cos theta_i cos theta_o) and the weight f cos theta_i / pdf, with no
// guard against a division by 0.
// In float32 an albedo of 1 becomes 3000 at alpha = 1e-6: D fails, and nothing bounds it.
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
  if (wo.z < 0.0 || wi.z < 0.0) return vec3(0.0);
  vec3 wm = normalize(wo + wi);
  float G = G2(wo, wi, Lambda(wo, material.alpha), Lambda(wi, material.alpha));
  vec3 facet = F(cos_facet(wo, wi), material.eta, material.k);
  return energy_f(D(wm, material.alpha) * G * facet / (4.0 * wi.z * wo.z), wo, wi);
}

float pdf(vec3 wo, vec3 wi) {
  if (wo.z < 0.0 || wi.z < 0.0) return 0.0;
  return energy_pdf(pdf_wi(wo, wi, D(normalize(wo + wi), material.alpha), material.alpha), wo, wi);
}

vec3 sample_f(vec3 wo, vec2 u, out vec3 wi) {
  wi = energy_wi(wo, u);
  if (wi.z < 0.0) return vec3(0.0);
  return f(wo, wi) * wi.z / pdf(wo, wi);
}
