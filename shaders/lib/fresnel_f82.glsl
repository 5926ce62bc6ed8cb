// Slot fresnel: Schlick's approximation bent to the exact reflectance at 82 degrees of eta + i k (a dielectric has k = 0).
// Largest absolute error: 0.028 for glass (eta = 1.5, at 68 degrees), 0.058 at eta = 1.05, 0.032 at 3.5, 0.074 for a metal of
// 5.6 + 1.2 i, 0.0039 for one of 0.143 + 3.98 i. It knows no total internal reflection, as Schlick's does not.
#include "lib/fresnel.glsl"
#include "lib/schlick.glsl"

vec3 F(float c, vec3 eta, vec3 k) {
  float edge = 1.0 / 7.0;
  return vec3(F_f82(c, F0(eta.r, k.r), F_conductor(edge, eta.r, k.r)), F_f82(c, F0(eta.g, k.g), F_conductor(edge, eta.g, k.g)),
              F_f82(c, F0(eta.b, k.b), F_conductor(edge, eta.b, k.b)));
}
