// Slot fresnel: the reflectance at normal incidence of eta + i k, at all angles.
// Errs by 1 - F0 at grazing angles, where everything reflects all: by 0.96 for glass, 0.03 for gold's red.
#include "lib/fresnel.glsl"

vec3 F(float c, vec3 eta, vec3 k) { return vec3(F0(eta.r, k.r), F0(eta.g, k.g), F0(eta.b, k.b)); }
