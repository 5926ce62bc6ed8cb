// What the samplers of the slot share that draw normals with density D cos theta_m, of all facets whether they are seen or not.
// By the reflection's Jacobian pdf = D wm.z / (4 wo . wm), Walter et al. 2007, Eqs. 24 and 38; with h = wo + wi, wm.z is
// h.z / |h| and wo . wm is |h| / 2.

float pdf_wi(vec3 wo, vec3 wi, float density, vec2 alpha) {
  vec3 h = wo + wi;
  return density * h.z / (2.0 * dot(h, h));
}

float weight_wi(vec3 wo, vec3 wi, float density, vec2 alpha) {
  vec3 h = wo + wi;
  return dot(h, h) / (2.0 * h.z);
}
