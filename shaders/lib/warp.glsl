// Maps from the unit square to directions.
#include "lib/common.glsl"

// Direction with the same density, 1 / (2 pi), everywhere above z = 0. q (2 - q) is 1 - z z without its cancellation near z = 1.
vec3 uniform_hemisphere(vec2 u) {
  float phi = TWO_PI * u.y;
  float r = sqrt(u.x * (2.0 - u.x));
  return vec3(r * cos(phi), r * sin(phi), 1.0 - u.x);
}

// Direction with density cos(theta) / pi about +z. z = sqrt(1 - u) and not sqrt(1 - x x - y y), which cancels near 0.
vec3 cosine_hemisphere(vec2 u) {
  float phi = TWO_PI * u.y;
  float r = sqrt(u.x);
  return vec3(r * cos(phi), r * sin(phi), sqrt(1.0 - u.x));
}
