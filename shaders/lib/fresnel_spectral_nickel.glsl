// Slot fresnel, spectral: nickel, main/Ni/Johnson of refractiveindex.info (CC0).
#include "lib/spectrum.glsl"

const mat4 ETA = mat4(
  1.7042, 1.7148, 1.7408, 1.7863,
  1.8142, 1.8354, 1.8652, 1.9144,
  1.9386, 1.9599, 1.9756, 1.9904,
  1.9901, 1.9889, 2.0059, 2.0523
);
const mat4 KAPPA = mat4(
  2.7122, 2.8716, 2.9825, 3.1109,
  3.2234, 3.3452, 3.4673, 3.5906,
  3.6969, 3.7999, 3.9132, 4.0260,
  4.1282, 4.2328, 4.3236, 4.4703
);

vec3 F(float c, vec3 eta, vec3 k) { return F_spectral(c, ETA, KAPPA); }
