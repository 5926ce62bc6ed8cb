// Slot sampling: the same for all normals.
#include "lib/sampling_uniform.glsl"
