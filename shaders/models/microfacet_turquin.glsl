// Slot energy of microfacet: single scattering, brighter.
#include "lib/energy_turquin.glsl"
#include "lib/lost_{ndf}_{shadowing}.glsl"

vec3 energy_f(vec3 single, vec3 wo, vec3 wi) {
  return single * gain_turquin(F(1.0, material.eta, material.k), lost(wo, material.alpha));
}

float energy_pdf(float single, vec3 wo, vec3 wi) { return single; }

vec3 energy_wi(vec3 wo, vec2 u) { return sample_wi(wo, u, material.alpha); }

vec3 energy_weight(vec3 single, vec3 wo, vec3 wi) { return energy_f(single, wo, wi); }
