// Slot lighting: a directional light.
#include "views/directional.glsl"

vec3 radiance(vec3 wo, mat3 frame) { return radiance_directional(wo, frame); }
