// Slot paint: the map's colour of the value.
#include "lib/colormap.glsl"

vec3 paint(float height) { return viridis(height); }
