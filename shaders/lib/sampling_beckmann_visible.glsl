// Slot sampling: visible normals, D_visible = D (wo . wm)+ / visible_area. Heitz and d'Eon 2014, "Importance Sampling
// Microfacet-Based BSDFs using the Distribution of Visible Normals", section 4; the CDFs are solved, not fitted.
#include "lib/beckmann.glsl"
#include "lib/common.glsl"
#include "lib/ndf_beckmann.glsl"
#include "lib/transcendental.glsl"

// Slope along the view's azimuth, by Newton's method kept inside a bracket, of facets with alpha = 1 seen from the direction
// (sin_o, 0, cos_o): where the visible area of facets with a smaller slope is u of the whole. The area's CDF is
// cos_o erfc(-x)/2 + sin_o exp(-x^2) / (2 sqrt(pi)); above 0 its complement is solved, so that neither tail is rounded away.
float visible_slope_beckmann(float u, float sin_o, float cos_o) {
  const float HALF_INV_SQRT_PI = 0.282094792;
  float low = -6.0;
  if (u == 0.0) return low;  // the root is at -infinity: 24 steps would end anywhere on the way
  float high = clamp(cos_o / max(sin_o, 1e-9), -6.0, 6.0);  // beyond 6 lies 1e-17 of the area; facets steeper than cot face away
  float head = 0.5 * cos_o + HALF_INV_SQRT_PI * sin_o;  // visible area of the slopes below 0
  float tail = sin_o * exp_precise(-high * high) * h_beckmann(abs(high));  // visible area less cos_o, or from below all of it
  float area = max(cos_o, 0.0) + tail;
  bool upper = cos_o > 0.0 && u * area > head;
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

// A visible normal; wo may lie below the horizon.
vec3 sample_wm(vec3 wo, vec2 u, vec2 alpha) {
  vec3 v = normalize(vec3(alpha * wo.xy, wo.z));
  float sin_o = length(v.xy);
  vec2 azimuth = sin_o > 0.0 ? v.xy / sin_o : vec2(1.0, 0.0);
  float along = visible_slope_beckmann(u.x, sin_o, v.z);
  float across = visible_slope_beckmann(u.y, 0.0, 1.0);
  vec2 slope = along * azimuth + across * vec2(-azimuth.y, azimuth.x);
  return normalize(vec3(-alpha * slope, 1.0));
}

vec3 sample_wi(vec3 wo, vec2 u, vec2 alpha) { return mirror(wo, sample_wm(wo, u, alpha)); }

float pdf_wi(vec3 wo, vec3 wi, float density, vec2 alpha) { return density / (4.0 * visible_area(wo, alpha)); }

float weight_wi(vec3 wo, vec3 wi, float density, vec2 alpha) { return visible_area(wo, alpha); }
