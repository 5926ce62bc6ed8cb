// Slot fresnel_mean: of a dielectric. From outside, our rational minimax fit in eta - 1 over [1, 20], all coefficients positive, errs by
// 1.5e-4; from inside it is 1 - (1 - that of 1 / eta) eta^2, exactly, since as much light goes out as in.

float F_mean_dielectric(float eta) {
  float x = max(eta - 1.0, (1.0 - eta) / eta);
  float p = 0.31063493 + x * (0.72676247 + x * 0.80208363);
  float q = 1.0 + x * (5.03409298 + x * (4.61229612 + x * 0.80887551));
  float inside = min(eta, 1.0);
  return (1.0 - inside) * (1.0 + inside) + inside * inside * (x * p / q);
}

vec3 F_mean(vec3 eta, vec3 k) { return vec3(F_mean_dielectric(eta.r), F_mean_dielectric(eta.g), F_mean_dielectric(eta.b)); }
