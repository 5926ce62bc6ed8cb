// Slot lighting: an environment.
#include "views/environment_{estimator}.glsl"

vec3 radiance(vec3 wo, mat3 frame) { return radiance_environment(wo, frame); }
