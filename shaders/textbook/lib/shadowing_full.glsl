// Slot shadowing: fully correlated as printed, min(G1, G1).
float G2(vec3 wo, vec3 wi, float Lambda_o, float Lambda_i) { return min(1.0 / (1.0 + Lambda_o), 1.0 / (1.0 + Lambda_i)); }
