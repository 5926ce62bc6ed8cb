// Slot tonemap: Khronos PBR Neutral (2024): colours below 0.8 stay as they are, brighter ones are compressed and desaturated.
vec3 tonemap(vec3 color) {
  const float START = 0.8 - 0.04;
  float low = min(color.r, min(color.g, color.b));
  color -= low < 0.08 ? low - 6.25 * low * low : 0.04;
  float peak = max(color.r, max(color.g, color.b));
  if (peak < START) return color;
  float room = 1.0 - START;
  float compressed = 1.0 - room * room / (peak + room - START);
  color *= compressed / peak;
  return mix(vec3(compressed), color, 1.0 / (0.15 * (peak - compressed) + 1.0));
}
