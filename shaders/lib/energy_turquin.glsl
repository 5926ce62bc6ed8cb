// Slot energy: single scattering is made as bright as white facets would need, times what a facet reflects along the normal. Turquin
// 2019, "Practical multiple scattering compensation for microfacet models", whose E is a table; here it is a fit. Not reciprocal, by
// up to 0.69 of the larger value; and it brightens the lobe, where light of more than one reflection is spread wide.

// F0 (1 - E) / E more, where lost_o = 1 - E(wo).
vec3 gain_turquin(vec3 F0, float lost_o) { return 1.0 + F0 * (lost_o / (1.0 - lost_o)); }
