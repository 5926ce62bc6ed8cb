// Slot facet: f_mf of a facet that reflects as Lambert's law says, albedo / pi.
//
// All files of the slot define four functions. facet_sharpness is the kappa of the integral in facets.glsl; facet_scale is what f_mf
// is at the peak of that lobe, 1/sr; facet_wi draws a direction to the light, which may lie below the horizon, and facet_pdf is its
// density per solid angle.
#include "lib/common.glsl"
#include "lib/warp.glsl"

float facet_sharpness(float kappa) { return 0.0; }

vec3 facet_scale(float c, vec3 albedo, vec3 eta, vec3 k, float kappa) { return INV_PI * albedo; }

vec3 facet_wi(vec3 wo, vec2 u, vec2 alpha, float kappa) { return cosine_hemisphere(u); }

float facet_pdf(vec3 wo, vec3 wi, vec2 alpha, float kappa) { return INV_PI * wi.z; }
