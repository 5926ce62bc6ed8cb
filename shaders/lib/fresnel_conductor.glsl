// Slot fresnel: exact, complex index eta + i k.
#include "lib/fresnel.glsl"

vec3 F(float c, vec3 eta, vec3 k) {
  return vec3(F_conductor(c, eta.r, k.r), F_conductor(c, eta.g, k.g), F_conductor(c, eta.b, k.b));
}
