// Slot masking: how the microsurface hides from wo and wi a facet that reflects, and one that transmits. Both exact for Smith's
// random heights: a facet with the share C of all heights below it is seen from above with the chance C^Lambda and from below with
// (1 - C)^Lambda, and the mean of their product over C is the Beta function. Heitz et al. 2016, "Multiple-Scattering Microfacet
// BSDFs with the Smith Model", section 5.2 and its walk's first order.
#include "lib/beta.glsl"

float G2_reflected(float Lambda_o, float Lambda_i) { return 1.0 / (1.0 + Lambda_o + Lambda_i); }

float G2_transmitted(float Lambda_o, float Lambda_i) { return beta_one_plus(Lambda_o, Lambda_i); }
