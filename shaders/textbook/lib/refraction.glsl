// Refraction by a facet as printed: Walter et al. 2007, Eqs. 16 and 40; the share that passes is 1 - F.
// In float32 the sum's slopes err by 1e-3 of an alpha of 1e-4, and 1 - F has no digits where little passes.
#include "lib/fresnel.glsl"

float apart_from_one(float eta) { return eta; }

vec3 upward(vec3 w) { return vec3(w.xy, abs(w.z)); }

vec3 sum_refracted(vec3 wo, vec3 wt, float eta) { return wo + eta * wt; }

vec2 cos_refracted(float L, float eta) {
  float e = eta * eta - 1.0;
  return vec2(abs(e - L * L), abs(e + L * L) / eta) / (2.0 * L);
}

float T_dielectric(float cos_o, float cos_t, float eta) { return 1.0 - F_dielectric(cos_o, eta); }

float T_spread(vec3 m, float eta) {
  float L = length(m);
  vec2 c = cos_refracted(L, eta);
  return m.z > 0.0 ? T_dielectric(c.x, c.y, eta) * c.x * c.y / (L * L) : 0.0;
}

vec3 refracted(vec3 w, vec3 wm, float eta) {
  float c = dot(w, wm);
  float inverse = 1.0 / eta;
  return (inverse * c - sqrt(1.0 + inverse * inverse * (c * c - 1.0))) * wm - inverse * w;
}
