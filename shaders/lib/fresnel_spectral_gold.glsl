// Slot fresnel, spectral: gold, main/Au/Johnson of refractiveindex.info (CC0).
#include "lib/spectrum.glsl"

const mat4 ETA = mat4(
  1.4631, 1.4262, 1.3649, 1.2870,
  1.0927, 0.7926, 0.5567, 0.4502,
  0.3635, 0.2909, 0.2485, 0.2076,
  0.1789, 0.1477, 0.1349, 0.1332
);
const mat4 KAPPA = mat4(
  1.9557, 1.9386, 1.8983, 1.8470,
  1.8236, 1.9621, 2.1729, 2.4222,
  2.6428, 2.8617, 3.0743, 3.2851,
  3.4622, 3.6450, 3.8001, 4.0518
);

vec3 F(float c, vec3 eta, vec3 k) { return F_spectral(c, ETA, KAPPA); }
