// Slot diffuse: f of a diffuse law in 1/sr, both directions above the horizon. Lambert: the same radiance in all directions.
#include "lib/common.glsl"

vec3 diffuse_f(vec3 wo, vec3 wi, vec3 albedo, float sigma, float r) { return INV_PI * albedo; }
