// Slot smith: Walter's rational fit of Beckmann's G1 as printed (Walter et al. 2007, Eq. 27), as Lambda = 1/G1 - 1.
// The fit of G1 exceeds 1 for a in (1.548, 1.6), so Lambda is negative there.
#include "textbook/stretch.glsl"

float Lambda(vec3 w, vec2 alpha) {
  float a = smith_a(w, alpha);
  float G1 = a < 1.6 ? (3.535 * a + 2.181 * a * a) / (1.0 + 2.276 * a + 2.577 * a * a) : 1.0;
  return 1.0 / G1 - 1.0;
}
