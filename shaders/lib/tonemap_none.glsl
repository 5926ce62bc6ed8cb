// Slot tonemap: none; what is above 1 is cut off.
vec3 tonemap(vec3 color) { return color; }
