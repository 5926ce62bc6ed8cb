// Slot lighting: a directional light and an environment.
#include "views/directional.glsl"
#include "views/environment_{estimator}.glsl"

vec3 radiance(vec3 wo, mat3 frame) { return radiance_directional(wo, frame) + radiance_environment(wo, frame); }
