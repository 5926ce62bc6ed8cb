// Slot sampling: Beckmann has no caps; visible normals.
#include "lib/sampling_beckmann_visible.glsl"
