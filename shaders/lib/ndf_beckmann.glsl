// Slot ndf: Beckmann, the normals of a surface with Gaussian heights. Beckmann and Spizzichino 1963; Walter et al. 2007,
// Eq. 25. Anisotropic by stretching, as GGX.
#include "lib/beckmann.glsl"
#include "lib/common.glsl"
#include "lib/transcendental.glsl"

// The leading 8 bits of each number: a product of three such numbers is exact.
vec2 leading(vec2 x) { return uintBitsToFloat(floatBitsToUint(x) & 0xffff0000u); }

// Density of microfacet area over normals, 1/sr; D cos integrates to 1. wm may have any length: a half vector's normalisation
// would only add rounding. The exponential multiplies the relative error of slope^2 by slope^2, up to 87; so the slope is a
// multiple of 1/8, whose square is exact, and a rest, from products in parts: 2.4e-5 -> 1e-6.
float D(vec3 wm, vec2 alpha) {
  if (wm.z <= 0.0) return 0.0;
  vec2 run = alpha * wm.z;
  vec2 slope = wm.xy / run;
  if (dot(slope, slope) > 174.0) return 0.0;  // D is out of float32's range for any alpha
  slope = floor(slope * 8.0 + 0.5) / 8.0;
  vec2 z = vec2(wm.z);
  vec2 low = leading(alpha) * (z - leading(z)) + (alpha - leading(alpha)) * z;
  vec2 rest = (wm.xy - slope * leading(alpha) * leading(z) - slope * low) / run;
  // half the exponent at a time, so that D is 0 only where it leaves float32's range
  float root = exp_precise(-0.5 * dot(slope, slope)) * exp_precise(-dot(rest, slope + 0.5 * rest));
  float c2 = wm.z * wm.z / dot(wm, wm);
  return root / (PI * alpha.x * alpha.y * c2 * c2) * root;
}

// Area of the facets visible from wo, wo.z > 0, projected along wo: wo.z (1 + Lambda), the integral of D (wo . wm)+.
float visible_area(vec3 wo, vec2 alpha) { return wo.z + z_Lambda_beckmann(wo, alpha); }

// Slope along the view's azimuth, by Newton's method kept inside a bracket, of facets with alpha = 1 seen from the direction
// (sin_o, 0, cos_o): where the visible area of facets with a smaller slope is u of the whole. The area's CDF is
// cos_o erfc(-x)/2 + sin_o exp(-x^2) / (2 sqrt(pi)); above 0 its complement is solved, so that neither tail is rounded away.
float visible_slope_beckmann(float u, float sin_o, float cos_o) {
  const float HALF_INV_SQRT_PI = 0.282094792;
  float low = -6.0;
  float high = min(cos_o / max(sin_o, 1e-9), 6.0);  // beyond 6 lies 1e-17 of the area; facets steeper than cot face away
  float head = 0.5 * cos_o + HALF_INV_SQRT_PI * sin_o;  // visible area of the slopes below 0
  float tail = sin_o * exp_precise(-high * high) * h_beckmann(high);  // visible area less cos_o: cos_o Lambda
  float area = cos_o + tail;
  bool upper = u * area > head;
  if (upper) low = 0.0; else high = min(high, 0.0);
  float x = 0.5 * (low + high);
  for (int i = 0; i < 24; ++i) {
    float gauss = exp_precise(-x * x);
    float half_erfcx = 0.5 * cos_o * erfcx_precise(abs(x));
    float error = upper ? (1.0 - u) * area - tail - gauss * (half_erfcx - HALF_INV_SQRT_PI * sin_o)
                        : gauss * (half_erfcx + HALF_INV_SQRT_PI * sin_o) - u * area;
    if (error > 0.0) high = x; else low = x;
    float density = (cos_o - x * sin_o) * gauss * 2.0 * HALF_INV_SQRT_PI;
    float next = density > 0.0 ? x - error / density : low - 1.0;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    float change = next - x;
    x = next;
    if (abs(change) < 1e-7 * (1.0 + abs(x))) break;
  }
  return x;
}

// A normal distributed as D_visible = D (wo . wm)+ / visible_area. Heitz and d'Eon 2014, "Importance Sampling
// Microfacet-Based BSDFs using the Distribution of Visible Normals", section 4; the CDFs are solved, not fitted.
vec3 sample_D_visible(vec3 wo, vec2 u, vec2 alpha) {
  vec3 v = normalize(vec3(alpha * wo.xy, wo.z));
  float sin_o = length(v.xy);
  vec2 azimuth = sin_o > 0.0 ? v.xy / sin_o : vec2(1.0, 0.0);
  float along = visible_slope_beckmann(u.x, sin_o, v.z);
  float across = visible_slope_beckmann(u.y, 0.0, 1.0);
  vec2 slope = along * azimuth + across * vec2(-azimuth.y, azimuth.x);
  return normalize(vec3(-alpha * slope, 1.0));
}
