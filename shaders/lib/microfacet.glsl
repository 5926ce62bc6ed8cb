// The geometry of reflection by a facet.

// wo . wm = wi . wm, the cosine at the facet, as |wo + wi| / 2: 1 + wo . wi would cancel where wi is near -wo.
float cos_facet(vec3 wo, vec3 wi) { return min(0.5 * length(wo + wi), 1.0); }
