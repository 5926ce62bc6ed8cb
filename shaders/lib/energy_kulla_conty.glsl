// Slot energy: what single scattering loses is added as a wide lobe. Kulla and Conty 2017, "Revisiting Physically Based Shading at
// Imageworks", after Kelemen and Szirmay-Kalos 2001: (1 - E(wo)) (1 - E(wi)) / (pi (1 - E_mean)), times F_multiple. With white facets
// the albedo is 1; reciprocal. Leaves out that the second reflection keeps something of the lobe while alpha is small.

#include "lib/common.glsl"
#include "lib/lost.glsl"
#include "lib/transcendental.glsl"

// Cosines at which F is asked for its mean over directions, weighted by the cosine: Gauss's three points. Exact for Schlick's F; errs by up
// to 0.002 for metals, k > 1, by 0.003 for glass, eta > 1, and by 0.22 where total reflection begins, eta < 1 and k small.
const vec3 COSINES = vec3(0.212340538239, 0.590533135559, 0.911412040487);

vec3 F_mean(vec3 F_1, vec3 F_2, vec3 F_3) { return 0.139653959803 * F_1 + 0.458482212719 * F_2 + 0.401863827478 * F_3; }

// What facets that each reflect F, a mean, return of the light that one reflection lost: of each further reflection E_mean leaves. Two at
// least have been made, so F counts twice.
vec3 F_multiple(vec3 F, float lost_mean) {
  return F * F * ((1.0 - lost_mean) / (1.0 - F * lost_mean));
}

// The lobe of white facets, 1/sr.
float wide(float lost_o, float lost_i, float lost_mean) { return lost_o * lost_i / (PI * lost_mean); }

// The share of directions drawn from sample_wide: its share of the light, F being the mean colour F0.
float share_wide(vec3 F0, float lost_o) {
  float F = (F0.r + F0.g + F0.b) / 3.0;
  return F * lost_o / (1.0 - lost_o + F * lost_o);
}

// Directions with a density proportional to cos / (cos^2 + alpha_mean^2), as what is lost falls for GGX: by the cosine alone weights
// would grow as 1 / alpha^2.
vec3 sample_wide(vec2 u, vec2 alpha) {
  float a = alpha_mean(alpha);
  float z2 = min(a * a * expm1_precise(u.x * log_precise(1.0 + 1.0 / (a * a))), 1.0);
  float phi = TWO_PI * u.y, r = sqrt(1.0 - z2);
  return vec3(r * cos(phi), r * sin(phi), sqrt(z2));
}

float pdf_wide(vec3 w, vec2 alpha) {
  float a = alpha_mean(alpha);
  return w.z / (PI * (w.z * w.z + a * a) * log_precise(1.0 + 1.0 / (a * a)));
}
