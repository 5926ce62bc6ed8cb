// Slot fresnel, spectral: copper, main/Cu/Johnson of refractiveindex.info (CC0).
#include "lib/spectrum.glsl"

const mat4 ETA = mat4(
  1.2748, 1.2422, 1.2424, 1.2492,
  1.2229, 1.2039, 1.1441, 1.0366,
  0.8747, 0.7010, 0.4923, 0.2921,
  0.2663, 0.2280, 0.2147, 0.2144
);
const mat4 KAPPA = mat4(
  2.2239, 2.3449, 2.4175, 2.4927,
  2.5518, 2.5934, 2.6051, 2.5743,
  2.6339, 2.7035, 2.9624, 3.2215,
  3.4475, 3.6816, 3.8662, 4.1443
);

vec3 F(float c, vec3 eta, vec3 k) { return F_spectral(c, ETA, KAPPA); }
