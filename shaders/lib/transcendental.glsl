// Elementary functions to float32 accuracy. The built-in ones may err by 4e-6 (exp), 2e-5 (atan) or 4e-4 (asin), by driver.

// exp(x) for x <= 88, relative error 2.5e-7; 0 where the result would leave float32's normal range. No upper limit is
// imposed: a compiler makes `min` of it, which turns NaN into a number.
float exp_precise(float x) {
  if (x < -87.0) return 0.0;
  float n = floor(x * 1.44269504 + 0.5);
  float r = (x - n * 0.693359375) + n * 2.12194440e-4;  // ln 2 in two parts: n ln 2 is subtracted without rounding
  float series = 1.0 + r * (1.0 + r * (1.0 / 2.0 + r * (1.0 / 6.0 + r * (1.0 / 24.0 + r * (1.0 / 120.0 + r / 720.0)))));
  return series * uintBitsToFloat(uint(int(n) + 127) << 23);
}

// exp(x) - 1 for x in [0, 88], relative error 3e-7, also near 0.
float expm1_precise(float x) {
  if (x > 0.5) return exp_precise(x) - 1.0;
  return x * (1.0 + x * (1.0 / 2.0 + x * (1.0 / 6.0 + x * (1.0 / 24.0 + x * (1.0 / 120.0 + x * (1.0 / 720.0 + x / 5040.0))))));
}

// Natural logarithm of x > 0 in float32's normal range, relative error 1.2e-7, also near 1. Cephes logf's polynomial.
float log_precise(float x) {
  int e = int(floatBitsToUint(x) >> 23) - 127;
  float f = uintBitsToFloat((floatBitsToUint(x) & 0x7fffffu) | 0x3f800000u);  // in [1, 2)
  if (f > 1.41421356) {
    f *= 0.5;
    e += 1;
  }
  f -= 1.0;
  float p = 3.3333331174e-1 + f * (-2.4999993993e-1 + f * (2.0000714765e-1 + f * (-1.6668057665e-1 + f * (1.4249322787e-1
      + f * (-1.2420140846e-1 + f * (1.1676998740e-1 + f * (-1.1514610310e-1 + f * 7.0376836292e-2)))))));
  float n = float(e);  // ln 2 in two parts, as in exp_precise
  return (f + (f * f * (f * p - 0.5) - n * 2.12194440e-4)) + n * 0.693359375;
}

// Angle of the point (x, y) from the x axis, in [-pi, pi], relative error 3e-7; 0 at the origin. Cephes atanf's polynomial.
float atan2_precise(float y, float x) {
  float large = max(abs(x), abs(y));
  if (large == 0.0) return 0.0;
  float t = min(abs(x), abs(y)) / large;
  bool upper = t > 0.414213562;  // tan(pi/8)
  float s = upper ? (t - 1.0) / (t + 1.0) : t;
  float q = s * s;
  float angle = s + s * q * (-3.33329491539e-1 + q * (1.99777106478e-1 + q * (-1.38776856032e-1 + q * 8.05374449538e-2)));
  if (upper) angle += 0.785398163;
  if (abs(y) > abs(x)) angle = 1.57079633 - angle;
  if (x < 0.0) angle = 3.14159265 - angle;
  return y < 0.0 ? -angle : angle;
}

// exp(x^2) erfc(x) for x in [0, 6.5]: our rational minimax fit, all coefficients positive, relative error 5.1e-7.
float erfcx_precise(float x) {
  float p = 0.999999821 + x * (0.98888435 + x * (0.450288238 + x * 0.0872854677));
  float q = 1.0 + x * (2.11725 + x * (1.83951223 + x * (0.79717611 + x * 0.154749888)));
  return p / q;
}
