// Fresnel reflectance of unpolarised light at a smooth interface; c is the cosine of the angle of incidence, in [0, 1].
// Born and Wolf, Principles of Optics, sections 1.5.2 and 14.2. Rearranged so that nothing cancels as eta -> 1 or k -> 0.
// Leaves out interference in films and polarisation of the incident light.

// (eta cos theta_t)^2, negative at total internal reflection. Both forms are equal; each rounds less where it is taken: at
// grazing angles and eta just below 1 the first would make F_dielectric err by a factor of 20.
float eta2_cos2_t(float c, float eta) {
  return eta < 0.7 ? eta * eta - (1.0 - c) * (1.0 + c) : (eta - 1.0) * (eta + 1.0) + c * c;
}

// Dielectric; eta is the transmitted over the incident index. 1 at total internal reflection.
float F_dielectric(float c, float eta) {
  float excess = (eta - 1.0) * (eta + 1.0);
  float s2 = (1.0 - c) * (1.0 + c);
  float square = eta2_cos2_t(c, eta);
  if (square <= 0.0) return 1.0;
  float t = sqrt(square);
  float rs = excess / ((c + t) * (c + t));  // (t - c) / (t + c) without its cancellation: 2e-4 -> 8e-7 at eta = 1.001
  float rp = rs * (c * t - s2) / (c * t + s2);
  return 0.5 * (rs * rs + rp * rp);
}

// Conductor of complex index eta + i k over the incident medium's.
float F_conductor(float c, float eta, float k) {
  float excess = (eta - 1.0) * (eta + 1.0);
  float s2 = (1.0 - c) * (1.0 + c);
  float square = eta2_cos2_t(c, eta) - k * k;  // Re (n cos theta_t)^2
  float root = sqrt(0.5 * (sqrt(square * square + 4.0 * eta * eta * k * k) + abs(square)));
  float other = root > 0.0 ? eta * k / root : 0.0;
  float a = square > 0.0 ? root : other;  // n cos theta_t = a + i b; the smaller of a, b by division, not by difference
  float b = square > 0.0 ? other : root;
  float sum = (c + a) * (c + a) + b * b;
  if (sum == 0.0) return 1.0;  // eta = 1, k = 0, c = 0: the grazing limit
  // a - c; its quotient would make F 238 instead of 1 where light is all reflected: c = 1e-8, eta = 0.66, k = 2e-11
  float difference = square > 0.0 ? (excess - k * k + b * b) / (c + a) : a - c;
  float Rs = (difference * difference + b * b) / sum;
  float cb2 = c * c * b * b;
  float Rp = Rs * ((c * a - s2) * (c * a - s2) + cb2) / ((c * a + s2) * (c * a + s2) + cb2);
  return 0.5 * (Rs + Rp);
}

// Reflectance at normal incidence.
float F0(float eta, float k) {
  return ((eta - 1.0) * (eta - 1.0) + k * k) / ((eta + 1.0) * (eta + 1.0) + k * k);
}
