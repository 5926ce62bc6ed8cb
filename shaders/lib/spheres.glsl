// Light among Lambertian spheres, each of which reflects the share c of its light: d'Eon 2021, "An Analytic BRDF for Materials
// with Spherical Lambertian Scatterers". The phase function of one, exactly, and c of a diffuse albedo.
#include "lib/common.glsl"
#include "lib/transcendental.glsl"

// The phase function of a Lambertian sphere, 1/sr: 2 (sin x - x cos x) / (3 pi^2), where x is the deflection, the angle between
// -wi and wo; by its series where that cancels. Lambert 1760; Blinn 1982.
float phase(vec3 wo, vec3 wi) {
  float forth = length(wo + wi), back = length(wo - wi);
  float x = 2.0 * atan2_precise(forth, back);
  float x2 = x * x;
  float cubic = x * x2 * (1.0 / 3.0 - x2 * (1.0 / 30.0 - x2 * (1.0 / 840.0 - x2 * (1.0 / 45360.0 - x2 / 3991680.0))));
  if (x > 0.8) cubic = 0.5 * forth * back - 0.25 * x * (back * back - forth * forth);
  return 2.0 / (3.0 * PI * PI) * cubic;
}

// c of a diffuse albedo, d'Eon's fit, Eq. 46. Takes c above 1 by up to 3e-10 where the albedo is above 0.9988.
vec3 sphere_c(vec3 albedo) {
  vec3 c;
  for (int i = 0; i < 3; i++) {
    float a = albedo[i];
    float lost = a < 1.0 ? log_precise(1.0 - a) : -87.0;
    // 1 - (1 - a)^2.73556, for small albedos by its binomial series
    float share = 1.0 - exp_precise(2.73556 * lost);
    if (a < 0.1) share = a * (2.73556 - a * (2.3738642568 - a * (0.5820398709 + a * (0.0384786565 + a * 0.0097307507))));
    c[i] = share / (1.0 - 0.184096 * exp_precise(2.48423 * lost));
  }
  return c;
}

// s = sqrt(1 - c), of the same fit.
vec3 sphere_s(vec3 albedo) {
  vec3 s;
  for (int i = 0; i < 3; i++) {
    float lost = albedo[i] < 1.0 ? log_precise(1.0 - albedo[i]) : -87.0;
    float power = exp_precise(2.48423 * lost);
    s[i] = sqrt(max(power * (exp_precise(0.25133 * lost) - 0.184096) / (1.0 - 0.184096 * power), 0.0));
  }
  return s;
}
