float quantity(vec3 wo, vec3 wi) { return pdf(wo, wi); }
