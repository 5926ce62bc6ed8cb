// Slot fresnel, spectral: chrome, main/Cr/Johnson of refractiveindex.info (CC0).
#include "lib/spectrum.glsl"

const mat4 ETA = mat4(
  2.0990, 2.2406, 2.3709, 2.5386,
  2.7144, 2.8568, 2.9965, 3.1620,
  3.2015, 3.2192, 3.1946, 3.1682,
  3.1339, 3.0986, 3.0773, 3.0598
);
const mat4 KAPPA = mat4(
  2.9495, 3.0809, 3.1643, 3.2506,
  3.2905, 3.3194, 3.3313, 3.3304,
  3.3169, 3.2999, 3.2999, 3.3005,
  3.3183, 3.3352, 3.3531, 3.3828
);

vec3 F(float c, vec3 eta, vec3 k) { return F_spectral(c, ETA, KAPPA); }
