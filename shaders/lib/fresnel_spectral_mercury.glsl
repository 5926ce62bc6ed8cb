// Slot fresnel, spectral: mercury, main/Hg/Inagaki of refractiveindex.info (CC0).
#include "lib/spectrum.glsl"

const mat4 ETA = mat4(
  0.9106, 1.0088, 1.0875, 1.1727,
  1.2610, 1.3504, 1.4409, 1.5321,
  1.6231, 1.7154, 1.8078, 1.8999,
  1.9969, 2.0962, 2.1861, 2.3392
);
const mat4 KAPPA = mat4(
  3.5604, 3.7671, 3.9117, 4.0667,
  4.2101, 4.3546, 4.4903, 4.6215,
  4.7537, 4.8811, 5.0083, 5.1365,
  5.2506, 5.3644, 5.4697, 5.6383
);

vec3 F(float c, vec3 eta, vec3 k) { return F_spectral(c, ETA, KAPPA); }
