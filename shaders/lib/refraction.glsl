// The geometry of refraction by a facet, and the share of the light that passes it. Of two directions one, wo, is above the surface
// and one, wt, below it; eta is the index below over that above. Walter et al. 2007, section 4: Eqs. 16, 17, 21 and 40.
#include "lib/fresnel.glsl"

// Nearer to 1 refraction would be a delta: float32 has no direction between its lobe's peak and its foot.
const float LEAST_EXCESS = 1.52587890625e-5;  // 2^-16

float apart_from_one(float eta) { return abs(eta - 1.0) < LEAST_EXCESS ? 1.0 + LEAST_EXCESS : eta; }

// w, mirrored to above the surface if it is below.
vec3 upward(vec3 w) { return vec3(w.xy, abs(w.z)); }

// The leading 12 bits: a product of two such numbers is exact.
vec3 leading12(vec3 x) { return uintBitsToFloat(floatBitsToUint(x) & 0xfffff000u); }

// wo + eta wt, Eq. 16 but for its length: along the facet's normal, against it if eta > 1. Its length L is |cos_o - eta cos_t|, its
// slopes are as small as alpha; so the product is taken in parts, lest its rounding, 6e-8, be 1e-3 of a slope of 1e-4.
vec3 sum_refracted(vec3 wo, vec3 wt, float eta) {
  vec3 e = leading12(vec3(eta));
  vec3 w = leading12(wt);
  return (wo + e * w) + (e * (wt - w) + (vec3(eta) - e) * wt);
}

// Cosines (above, below) of the directions at the facet, from their sum's length: by Snell's law eta cos_t + cos_o = |eta^2 - 1| / L.
// The smaller is a difference, and not above 0 where no facet refracts wt to wo.
vec2 cos_refracted(float L, float eta) {
  float q = abs((eta - 1.0) * (eta + 1.0)) / L;
  return 0.5 * (eta > 1.0 ? vec2(q - L, (q + L) / eta) : vec2(q + L, (q - L) / eta));
}

// 1 - F of unpolarised light, from both cosines: nothing cancels where little passes. The same from both sides.
float T_dielectric(float cos_o, float cos_t, float eta) {
  float s = cos_o + eta * cos_t;
  float p = eta * cos_o + cos_t;
  return 2.0 * eta * cos_o * cos_t * (1.0 / (s * s) + 1.0 / (p * p));
}

// What facets of normal m, L long, pass, over the spread of what they refract: T cos_o cos_t / L^2; 0 where none refracts. Eq. 21 is
// this times D G2, over both cosines; the same for both ways through.
float T_spread(vec3 m, float eta) {
  float L = length(m);
  vec2 c = cos_refracted(L, eta);
  if (m.z <= 0.0 || c.x <= 0.0 || c.y <= 0.0) return 0.0;
  return T_dielectric(c.x, c.y, eta) * (c.x / L) * (c.y / L);
}

// The direction into which w is refracted by a facet of normal wm, w . wm > 0; eta is the index of the other side over that of w.
// Eq. 40, as a difference from straight on, for eta -> 1. No total internal reflection.
vec3 refracted(vec3 w, vec3 wm, float eta) {
  float c = dot(w, wm);
  float t = sqrt(max(eta2_cos2_t(c, eta), 0.0));
  return (-w - (eta - 1.0) * (eta + 1.0) / (c + t) * wm) / eta;
}
