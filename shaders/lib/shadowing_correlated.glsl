// Slot shadowing: masking and shadowing are correlated by the height of the facet. Exact for Smith's random heights.
// Heitz 2014, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", Eq. 99.
float G2(vec3 wo, vec3 wi, float Lambda_o, float Lambda_i) { return 1.0 / (1.0 + Lambda_o + Lambda_i); }
