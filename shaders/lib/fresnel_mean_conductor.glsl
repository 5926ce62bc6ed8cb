// Slot fresnel_mean: of a conductor, by Gauss's two points for the weight c. Errs by up to 0.006 for k > 1, by 0.01 for a dielectric
// of eta > 1, and by up to 0.25 where total reflection begins, eta < 1 and k small.
#include "lib/fresnel.glsl"

float F_mean_conductor(float eta, float k) {
  return 0.363917238 * F_conductor(0.355051026, eta, k) + 0.636082762 * F_conductor(0.844948974, eta, k);
}

vec3 F_mean(vec3 eta, vec3 k) {
  return vec3(F_mean_conductor(eta.r, k.r), F_mean_conductor(eta.g, k.g), F_mean_conductor(eta.b, k.b));
}
