// The geometry of reflection by a facet, as the lecture prints it: the half vector normalised, then a dot product.
// In float32 wo + wi is all rounding where wi is near -wo: errors of 3 %, and cosines below 0.
float cos_facet(vec3 wo, vec3 wi) { return dot(wo, normalize(wo + wi)); }
