// Slot masking: correlated by height in reflection, and the same formula in transmission, as in pbrt. It lets too much through: a
// facet that is high, and well seen from above, is hidden from below. Error: see models/dielectric.
float G2_reflected(float Lambda_o, float Lambda_i) { return 1.0 / (1.0 + Lambda_o + Lambda_i); }

float G2_transmitted(float Lambda_o, float Lambda_i) { return 1.0 / (1.0 + Lambda_o + Lambda_i); }
