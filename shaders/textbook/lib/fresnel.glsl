// Fresnel's equations as printed: Snell's law, then the two amplitudes; for a conductor in real numbers, as in Pharr, Jakob and
// Humphreys, Physically Based Rendering, 3rd edition, section 8.2.1.
// In float32 a conductor's errs by 2 % as k -> 0 and is negative next to eta = 1; a dielectric's errs there as its question does.

float F_dielectric(float c, float eta) {
  float sin2_t = (1.0 - c * c) / (eta * eta);
  if (sin2_t >= 1.0) return 1.0;
  float ct = sqrt(1.0 - sin2_t);
  float rs = (c - eta * ct) / (c + eta * ct);
  float rp = (eta * c - ct) / (eta * c + ct);
  return (rs * rs + rp * rp) / 2.0;
}

float F_conductor(float c, float eta, float k) {
  float c2 = c * c;
  float s2 = 1.0 - c2;
  float t0 = eta * eta - k * k - s2;
  float a2b2 = sqrt(t0 * t0 + 4.0 * eta * eta * k * k);
  float a = sqrt((a2b2 + t0) / 2.0);
  float Rs = (a2b2 + c2 - 2.0 * a * c) / (a2b2 + c2 + 2.0 * a * c);
  float t3 = c2 * a2b2 + s2 * s2;
  float t4 = 2.0 * a * c * s2;
  float Rp = Rs * (t3 - t4) / (t3 + t4);
  return (Rs + Rp) / 2.0;
}

float F0(float eta, float k) {
  return ((eta - 1.0) * (eta - 1.0) + k * k) / ((eta + 1.0) * (eta + 1.0) + k * k);
}
