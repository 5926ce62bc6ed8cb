// Slot shadowing: correlated by azimuth. Where wo and wi share it, what one sees the other lights (G = min); a quarter turn
// apart they are independent. Ashikhmin, Premoze and Shirley 2000, "A Microfacet-based BRDF Generator", section 4: a
// Gaussian of 15 degrees, so 1 / (2 (15 deg)^2) = 7.3. Empirical, and blind to height.
#include "lib/transcendental.glsl"

float G2(vec3 wo, vec3 wi, float Lambda_o, float Lambda_i) {
  float phi = atan2_precise(abs(wo.x * wi.y - wo.y * wi.x), dot(wo.xy, wi.xy));
  float G1_o = 1.0 / (1.0 + Lambda_o);
  float G1_i = 1.0 / (1.0 + Lambda_i);
  return mix(G1_o * G1_i, min(G1_o, G1_i), exp_precise(-7.3 * phi * phi));
}
