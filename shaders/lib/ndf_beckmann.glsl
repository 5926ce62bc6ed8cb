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
