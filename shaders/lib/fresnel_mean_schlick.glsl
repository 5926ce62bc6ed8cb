// Slot fresnel_mean: of Schlick's approximation, exact: the mean of (1 - c)^5 over directions, weighted by c, is 1/21.
#include "lib/fresnel.glsl"

vec3 F_mean(vec3 eta, vec3 k) {
  vec3 normal = vec3(F0(eta.r, k.r), F0(eta.g, k.g), F0(eta.b, k.b));
  return normal + (1.0 - normal) / 21.0;
}
