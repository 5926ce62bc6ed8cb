// Schlick's curves as printed, by pow.

float F_schlick(float c, float F0) { return F0 + (1.0 - F0) * pow(1.0 - c, 5.0); }

float F_f82(float c, float F0, float F82) {
  float edge = F_schlick(1.0 / 7.0, F0);
  float b = (edge - min(F82, edge)) / (1.0 / 7.0 * pow(6.0 / 7.0, 6.0));
  return max(F_schlick(c, F0) - b * c * pow(1.0 - c, 6.0), 0.0);
}
