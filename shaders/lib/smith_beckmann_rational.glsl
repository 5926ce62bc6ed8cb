// Slot smith: Walter's rational fit of Beckmann's G1 (Walter et al. 2007, Eq. 27), as Lambda = 1/G1 - 1. G1 errs by up
// to 3.1e-3 (at a = 1.34). From a = 1.548 to 1.6 the fit of G1 exceeds 1, by 6e-5; there Lambda is 0. Where 1/Lambda is
// needed this is no substitute: its relative error reaches 100 %.
float Lambda(vec3 w, vec2 alpha) {
  float s = length(alpha * w.xy);
  if (w.z > 1.6 * s) return 0.0;
  float a = w.z / s;
  return max((1.0 + a * (-1.259 + a * 0.396)) / (a * (3.535 + a * 2.181)), 0.0);
}
