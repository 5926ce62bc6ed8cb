// Smith's Lambda of Gaussian slopes, exact to float32. Smith 1967; Walter et al. 2007, Eq. 26; Heitz 2014, Eq. 66:
// Lambda = (exp(-a^2) / (a sqrt(pi)) - erfc(a)) / 2 = exp(-a^2) h(a) / a, a = 1 / (alpha tan theta).
#include "lib/transcendental.glsl"

// h(a) = 1/(2 sqrt(pi)) - a erfcx(a) / 2 for a in [0, 9.4]: our rational minimax fit, all coefficients positive, so that
// nothing cancels: relative error 6.1e-7, where the textbook form errs by a factor of 75 for a in (2, 6).
float h_beckmann(float a) {
  float p = 0.282094861 + a * (0.220946927 + a * (0.0859263273 + a * 0.0153679274));
  float q = 1.0 + a * (2.55571132 + a * (2.83419129 + a * (1.7405838 + a * (0.608399704 + a * 0.108981171))));
  return p / q;
}

// w.z Lambda(w), w.z > 0: finite at grazing angles.
float z_Lambda_beckmann(vec3 w, vec2 alpha) {
  float s2 = dot(alpha * w.xy, alpha * w.xy);
  if (w.z * w.z > 86.5 * s2) return 0.0;  // exp(-a^2) leaves float32's range
  float a2 = w.z * w.z / s2;  // not the square of a: the exponential multiplies its roundings by a^2
  return sqrt(s2) * exp_precise(-a2) * h_beckmann(sqrt(a2));
}
