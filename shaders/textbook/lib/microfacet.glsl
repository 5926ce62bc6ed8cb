// The geometry of reflection by a facet, as the lecture prints it: the half vector normalised, then a dot product.
float cos_facet(vec3 wo, vec3 wi) { return dot(wo, normalize(wo + wi)); }
