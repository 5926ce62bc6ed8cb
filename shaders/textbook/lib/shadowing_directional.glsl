// Slot shadowing: correlated by azimuth, as printed: the angle by acos of the scalar product of the unit azimuths.
// In float32 the product of equal azimuths exceeds 1, of which acos is NaN; at normal incidence the azimuth is 0 / 0.
float G2(vec3 wo, vec3 wi, float Lambda_o, float Lambda_i) {
  float phi = acos(dot(normalize(wo.xy), normalize(wi.xy)));
  float lambda = exp(-7.3 * phi * phi);
  float G1_o = 1.0 / (1.0 + Lambda_o);
  float G1_i = 1.0 / (1.0 + Lambda_i);
  return (1.0 - lambda) * G1_o * G1_i + lambda * min(G1_o, G1_i);
}
