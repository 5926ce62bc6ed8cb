// Slot fresnel, spectral: palladium, main/Pd/Johnson of refractiveindex.info (CC0).
#include "lib/spectrum.glsl"

const mat4 ETA = mat4(
  1.3375, 1.3854, 1.4213, 1.4676,
  1.5110, 1.5477, 1.5864, 1.6340,
  1.6587, 1.6798, 1.7161, 1.7516,
  1.7724, 1.7943, 1.8152, 1.8548
);
const mat4 KAPPA = mat4(
  3.0480, 3.1865, 3.2905, 3.4091,
  3.5162, 3.6186, 3.7197, 3.8232,
  3.9219, 4.0200, 4.1178, 4.2152,
  4.3048, 4.3959, 4.4800, 4.6231
);

vec3 F(float c, vec3 eta, vec3 k) { return F_spectral(c, ETA, KAPPA); }
