// The density of reflected directions whose normals have the density D cos theta_m, as printed: Walter et al. 2007, Eqs. 24, 38.

float pdf_wi(vec3 wo, vec3 wi, float density, vec2 alpha) {
  vec3 wm = normalize(wo + wi);
  return density * wm.z / (4.0 * dot(wo, wm));
}

float weight_wi(vec3 wo, vec3 wi, float density, vec2 alpha) {
  vec3 wm = normalize(wo + wi);
  return dot(wo, wm) / wm.z;
}
