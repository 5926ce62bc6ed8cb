// Slot shadowing: fully correlated, G = min: whichever of masking and shadowing is stronger hides the other. Exact where
// wo = wi; elsewhere an upper bound. The lecture's "correlated", in its reciprocal reading.
float G2(vec3 wo, vec3 wi, float Lambda_o, float Lambda_i) { return 1.0 / (1.0 + max(Lambda_o, Lambda_i)); }
