// Slot smith: Smith's Lambda of GGX. Walter et al. 2007, Eq. 34; Heitz 2014, Eq. 72. Not as (sqrt(1 + t^2) - 1) / 2 with
// t = alpha tan theta, which errs by 2e-7 / t^2 in float32.
float Lambda(vec3 w, vec2 alpha) {
  float q = dot(alpha * w.xy, alpha * w.xy);
  return q / (2.0 * w.z * (w.z + sqrt(w.z * w.z + q)));
}
