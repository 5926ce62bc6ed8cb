// Slot masking: independent on both sides, Walter et al. 2007, Eq. 23, as in Mitsuba. Too dark in reflection, too bright in
// transmission. Error: see models/dielectric.
float G2_reflected(float Lambda_o, float Lambda_i) { return 1.0 / ((1.0 + Lambda_o) * (1.0 + Lambda_i)); }

float G2_transmitted(float Lambda_o, float Lambda_i) { return 1.0 / ((1.0 + Lambda_o) * (1.0 + Lambda_i)); }
