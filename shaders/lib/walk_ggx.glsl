// Slot walk: of GGX, for directions above and below the horizon.

// Area of the facets visible from w, projected along w: |w.z (1 + Lambda(w))|, the integral of D (w . wm)+. From below the horizon
// the sum of w.z and the length would cancel.
float projected_area(vec3 w, vec2 alpha) {
  vec2 s = alpha * w.xy;
  float v = length(vec3(s, w.z));
  return 0.5 * (w.z > 0.0 ? v + w.z : dot(s, s) / (v - w.z));
}
