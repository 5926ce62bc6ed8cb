// Slot fresnel, spectral: titanium, main/Ti/Johnson of refractiveindex.info (CC0).
#include "lib/spectrum.glsl"

const mat4 ETA = mat4(
  2.1524, 2.2356, 2.2823, 2.3265,
  2.3512, 2.4036, 2.4642, 2.5311,
  2.5681, 2.5998, 2.6360, 2.6721,
  2.7107, 2.7497, 2.7857, 2.8506
);
const mat4 KAPPA = mat4(
  2.9853, 3.0207, 3.0520, 3.1112,
  3.1746, 3.2508, 3.3322, 3.4162,
  3.4982, 3.5800, 3.6521, 3.7234,
  3.7740, 3.8264, 3.8724, 3.9410
);

vec3 F(float c, vec3 eta, vec3 k) { return F_spectral(c, ETA, KAPPA); }
