// Slot paint: one colour.
uniform vec3 ink;  // sRGB

vec3 paint(float height) { return ink; }
