// Slot energy of microfacet: single scattering as it is.
vec3 energy_f(vec3 single, vec3 wo, vec3 wi) { return single; }

float energy_pdf(float single, vec3 wo, vec3 wi) { return single; }

vec3 energy_wi(vec3 wo, vec2 u) { return sample_wi(wo, u, material.alpha); }

vec3 energy_weight(vec3 single, vec3 wo, vec3 wi) { return single; }
