// Slot ndf: Trowbridge-Reitz (GGX), an ellipsoid's normals. Trowbridge and Reitz 1975; Walter et al. 2007, Eq. 33.
// Anisotropic by stretching: normals are remapped by 1/alpha, directions by alpha (Heitz 2014, section 5.3).
#include "lib/common.glsl"

// Density of microfacet area over normals, 1/sr; D cos integrates to 1. Sums of squares only: nothing cancels at small alpha.
// wm may have any length: a half vector's normalisation would only add rounding.
float D(vec3 wm, vec2 alpha) {
  if (wm.z <= 0.0) return 0.0;
  vec3 v = vec3(wm.xy / alpha, wm.z);
  float s = dot(v, v) / dot(wm, wm);
  return 1.0 / (PI * alpha.x * alpha.y * s * s);
}

// Area of the facets visible from wo, wo.z > 0, projected along wo: wo.z (1 + Lambda), the integral of D (wo . wm)+.
float visible_area(vec3 wo, vec2 alpha) {
  return 0.5 * (wo.z + length(vec3(alpha * wo.xy, wo.z)));
}
