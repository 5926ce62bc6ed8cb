// Slot sampling: every direction above the horizon alike. It knows nothing of the material: the lobe is found by chance.
//
// All files of the slot define three functions of wo and wi above the horizon, with `density` for D at the facet's normal:
// sample_wi draws a direction to the light, which may lie below the horizon; pdf_wi is its density per solid angle; and
// weight_wi is D / (4 pdf_wi), of which the weight of a sample is F G2 / wo.z times, in a form in which what cancels does.
#include "lib/warp.glsl"

vec3 sample_wi(vec3 wo, vec2 u, vec2 alpha) { return uniform_hemisphere(u); }

float pdf_wi(vec3 wo, vec3 wi, float density, vec2 alpha) { return 0.5 * INV_PI; }

float weight_wi(vec3 wo, vec3 wi, float density, vec2 alpha) { return 0.5 * PI * density; }
