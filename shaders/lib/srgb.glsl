// sRGB, IEC 61966-2-1.

// Luminance of a linear colour: Rec. 709's weights.
float luminance(vec3 color) { return dot(color, vec3(0.2126, 0.7152, 0.0722)); }

// The transfer function, from linear values in [0, 1].
vec3 srgb_encode(vec3 linear) {
  vec3 bright = 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055;
  return mix(bright, 12.92 * linear, vec3(lessThanEqual(linear, vec3(0.0031308))));
}
