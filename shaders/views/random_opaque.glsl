// Slot body: random numbers of this pass, evenly spread over passes.
#include "lib/random.glsl"

vec2 random(uint stream) { return random2(uvec2(gl_FragCoord.xy), pass, stream); }
