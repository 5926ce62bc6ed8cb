#include "lib/srgb.glsl"

float quantity(vec3 wo, vec3 wi) { return luminance(f(wo, wi)) * abs(wi.z); }
