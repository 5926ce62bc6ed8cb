// Smith's Lambda of Gaussian slopes as the lecture prints it: (erf(a) - 1) / 2 + exp(-a^2) / (2 a sqrt(pi)).
// In float32 it cancels for a in (2, 6): negative there, for want of digits of erf(a) - 1.
#include "textbook/stretch.glsl"

// Abramowitz and Stegun, 7.1.26, as most renderers have it: absolute error 1.5e-7.
float erf_textbook(float x) {
  float t = 1.0 / (1.0 + 0.3275911 * x);
  float y = ((((1.061405429 * t - 1.453152027) * t + 1.421413741) * t - 0.284496736) * t + 0.254829592) * t;
  return 1.0 - y * exp(-x * x);
}

float Lambda_textbook(float a) { return (erf_textbook(a) - 1.0) / 2.0 + exp(-a * a) / (2.0 * a * sqrt(3.14159265)); }

float h_beckmann(float a) { return a * exp(a * a) * Lambda_textbook(a); }

float z_Lambda_beckmann(vec3 w, vec2 alpha) { return w.z * Lambda_textbook(smith_a(w, alpha)); }
