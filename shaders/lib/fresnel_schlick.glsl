// Slot fresnel: Schlick's approximation from the reflectance at normal incidence of eta + i k (a dielectric has k = 0).
// Largest absolute error: 0.036 for glass (eta = 1.5, at 85 degrees), 0.32 at eta = 1.05, 0.17 at 3.5, 0.29 for a metal of
// 5.6 + 1.2 i. It knows no total internal reflection: 0.96 at the critical angle from inside glass, eta = 1 / 1.5.
#include "lib/fresnel.glsl"
#include "lib/schlick.glsl"

vec3 F(float c, vec3 eta, vec3 k) {
  return vec3(F_schlick(c, F0(eta.r, k.r)), F_schlick(c, F0(eta.g, k.g)), F_schlick(c, F0(eta.b, k.b)));
}
