// Slot smith: GGX's Lambda needs no fit.
#include "lib/smith_ggx_exact.glsl"
