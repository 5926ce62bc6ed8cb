// What white facets lose, 1 - E(w): the light that they reflect onto facets, which leaves after more than one reflection. Fits by
// derive_lost.py in lost_{ndf}_{shadowing}.glsl, in s = cos / (cos + alpha) and alpha; this is what these share.
// Anisotropic facets are taken for isotropic ones of the root mean square of alpha, seen from where these have the same Lambda:
// w.xy stretched by alpha. That errs by up to 0.05 of the light for GGX and 0.10 for Beckmann, at any ratio of the two alphas; for GGX
// with separable shadowing by up to 0.09, and by 0.21 with directional where one alpha is 100 times the other.
// Of Beckmann with the rational smith it is the exact one's, which differs by up to 3e-3.

float alpha_mean(vec2 alpha) { return sqrt(0.5 * dot(alpha, alpha)); }

// s and 1 - s, each without cancellation.
vec2 parts(vec3 w, vec2 alpha) {
  float steep = length(vec3(alpha * w.xy, alpha_mean(alpha) * w.z));
  return vec2(w.z, steep) / (w.z + steep);
}

// The weights of three neighbours in a quadratic spline, f in [0, 1] between the first two knots.
vec3 spline(float f) { return vec3(0.5 * (1.0 - f) * (1.0 - f), 0.5 + f * (1.0 - f), 0.5 * f * f); }
