#include "lib/srgb.glsl"

float quantity(vec3 wo, vec3 wi) { return luminance(mean_f(wo, wi, walks)) * abs(wi.z); }
