// Slot energy of microfacet: single scattering and a wide lobe; of the directions drawn the wide lobe has its share.
#include "lib/energy_kulla_conty.glsl"
#include "lib/lost_{ndf}_{shadowing}.glsl"

vec3 wide_f(vec3 wo, vec3 wi) {
  float mean = lost_mean(material.alpha);
  vec3 facet = F_mean(F(COSINES.x, material.eta, material.k), F(COSINES.y, material.eta, material.k),
                      F(COSINES.z, material.eta, material.k));
  return F_multiple(facet, mean) * wide(lost(wo, material.alpha), lost(wi, material.alpha), mean);
}

float wide_share(vec3 wo) { return share_wide(F(1.0, material.eta, material.k), lost(wo, material.alpha)); }

vec3 energy_f(vec3 single, vec3 wo, vec3 wi) { return single + wide_f(wo, wi); }

float energy_pdf(float single, vec3 wo, vec3 wi) {
  return mix(single, pdf_wide(wi, material.alpha), wide_share(wo));
}

const float LARGEST = 1.0 - 0.5 / 8388608.0;  // the random number next to 1, to which rounding may take a stretched one

// u.x chooses the lobe, and what is left of it is as even as before.
vec3 energy_wi(vec3 wo, vec2 u) {
  float s = wide_share(wo);
  if (u.x < s) return sample_wide(vec2(u.x / s, u.y), material.alpha);
  return sample_wi(wo, vec2(min((u.x - s) / (1.0 - s), LARGEST), u.y), material.alpha);
}

vec3 energy_weight(vec3 single, vec3 wo, vec3 wi) {
  float own = pdf_wi(wo, wi, D(wo + wi, material.alpha), material.alpha);
  return (single * own + wide_f(wo, wi) * wi.z) / energy_pdf(own, wo, wi);
}
