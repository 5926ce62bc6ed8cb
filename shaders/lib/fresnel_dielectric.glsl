// Slot fresnel: exact, real index eta; k is ignored.
#include "lib/fresnel.glsl"

vec3 F(float c, vec3 eta, vec3 k) {
  return vec3(F_dielectric(c, eta.r), F_dielectric(c, eta.g), F_dielectric(c, eta.b));
}
