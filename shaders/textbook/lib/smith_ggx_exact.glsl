// Slot smith: Smith's Lambda of GGX as printed, Heitz 2014, Eq. 72: (-1 + sqrt(1 + 1/a^2)) / 2.
// In float32 the difference is 0 for slopes alpha tan theta below 2.4e-4: an error of 100 %.
#include "textbook/stretch.glsl"

float Lambda(vec3 w, vec2 alpha) {
  float a = smith_a(w, alpha);
  return (-1.0 + sqrt(1.0 + 1.0 / (a * a))) / 2.0;
}
