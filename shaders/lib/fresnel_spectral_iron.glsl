// Slot fresnel, spectral: iron, main/Fe/Johnson of refractiveindex.info (CC0).
#include "lib/spectrum.glsl"

const mat4 ETA = mat4(
  2.3737, 2.5275, 2.6104, 2.6806,
  2.7249, 2.8087, 2.8842, 2.9430,
  2.9473, 2.9396, 2.9089, 2.8797,
  2.8982, 2.9170, 2.9073, 2.8707
);
const mat4 KAPPA = mat4(
  2.6583, 2.7348, 2.7824, 2.8270,
  2.8718, 2.8981, 2.9158, 2.9266,
  2.9568, 2.9901, 3.0209, 3.0514,
  3.0726, 3.0937, 3.1223, 3.1795
);

vec3 F(float c, vec3 eta, vec3 k) { return F_spectral(c, ETA, KAPPA); }
