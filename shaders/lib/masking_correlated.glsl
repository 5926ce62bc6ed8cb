// Slot masking: correlated by height in reflection, and the same formula in transmission, as in pbrt. It lets too much through: a
// facet that is high, and well seen from above, is hidden from below. Of GGX at alpha = 0.6 and an index of 1.5 it transmits 0.74 at
// 80 degrees instead of 0.51, and at worst, alpha = 1 and 85 degrees, 0.69 instead of 0.09.
float G2_reflected(float Lambda_o, float Lambda_i) { return 1.0 / (1.0 + Lambda_o + Lambda_i); }

float G2_transmitted(float Lambda_o, float Lambda_i) { return 1.0 / (1.0 + Lambda_o + Lambda_i); }
