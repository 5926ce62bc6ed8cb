// Slot sampling: in proportion to the cosine, as for a diffuse surface; sampling_uniform.glsl says what the functions are.
#include "lib/warp.glsl"

vec3 sample_wi(vec3 wo, vec2 u, vec2 alpha) { return cosine_hemisphere(u); }

float pdf_wi(vec3 wo, vec3 wi, float density, vec2 alpha) { return INV_PI * wi.z; }

float weight_wi(vec3 wo, vec3 wi, float density, vec2 alpha) { return 0.25 * PI / wi.z * density; }
