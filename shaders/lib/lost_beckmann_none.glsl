// Slot lost: without shadowing nothing is lost, whatever the normals.
#include "lib/lost_none.glsl"
