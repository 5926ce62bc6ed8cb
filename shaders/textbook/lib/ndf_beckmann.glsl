// Slot ndf: Beckmann as the lecture prints it: exp(-tan^2 / alpha^2) / (pi alpha^2 cos^4), tan^2 = (1 - cos^2) / cos^2.
// In float32 tan^2 is a multiple of 1.2e-7: errors of 7e-5 at alpha = 0.05, and a factor of 9e6 at 1e-6.
#include "lib/beckmann.glsl"
#include "lib/common.glsl"

float D(vec3 wm, vec2 alpha) {
  float jacobian;
  float c = stretched(normalize(wm), alpha, jacobian);
  if (c <= 0.0) return 0.0;
  float c2 = c * c;
  float tan2 = (1.0 - c2) / c2;
  return exp(-tan2 / (alpha.y * alpha.y)) / (PI * alpha.y * alpha.y * c2 * c2) * jacobian;
}

float visible_area(vec3 wo, vec2 alpha) { return wo.z * (1.0 + Lambda_textbook(smith_a(wo, alpha))); }
