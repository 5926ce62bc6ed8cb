// Slot fresnel, spectral: no spectrum is known, so eta + i k at R, G, B.
#include "lib/fresnel_conductor.glsl"
