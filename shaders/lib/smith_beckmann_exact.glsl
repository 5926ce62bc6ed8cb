// Slot smith: Smith's Lambda of Beckmann, exact.
#include "lib/beckmann.glsl"

float Lambda(vec3 w, vec2 alpha) { return z_Lambda_beckmann(w, alpha) / w.z; }
