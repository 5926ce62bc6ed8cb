// Constants and the words that every chunk uses.

const float PI = 3.14159265358979;
const float TWO_PI = 6.28318530717959;
const float INV_PI = 0.318309886183791;

// A direction with a cosine below this lies on the horizon, where f is 0: there 4 cos cos would leave float32's range.
const float HORIZON = 1e-12;

// The direction w mirrored about the normal m, both away from the surface.
vec3 mirror(vec3 w, vec3 m) { return 2.0 * dot(w, m) * m - w; }
