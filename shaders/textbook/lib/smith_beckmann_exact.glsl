// Slot smith: Smith's Lambda of Beckmann as printed.
#include "lib/beckmann.glsl"

float Lambda(vec3 w, vec2 alpha) { return Lambda_textbook(smith_a(w, alpha)); }
