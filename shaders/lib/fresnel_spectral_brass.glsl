// Slot fresnel, spectral: brass, other/Cu-Zn/Querry-Cu70Zn30 of refractiveindex.info (CC0).
#include "lib/spectrum.glsl"

const mat4 ETA = mat4(
  1.3723, 1.2077, 1.0346, 0.8623,
  0.7298, 0.6370, 0.5773, 0.5358,
  0.4954, 0.4654, 0.4512, 0.4502,
  0.4434, 0.4446, 0.4440, 0.4462
);
const mat4 KAPPA = mat4(
  1.7882, 1.7886, 1.8551, 1.9885,
  2.1647, 2.3580, 2.5481, 2.7270,
  2.8981, 3.0797, 3.2542, 3.4166,
  3.5742, 3.7305, 3.8664, 4.0979
);

vec3 F(float c, vec3 eta, vec3 k) { return F_spectral(c, ETA, KAPPA); }
