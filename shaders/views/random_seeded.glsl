// Slot random: of a model that draws numbers of its own, for which each pixel and pass begins with another state.
#include "lib/random.glsl"

void seed_random(uint pass) { random_state = uvec3(uvec2(gl_FragCoord.xy), ~pass); }
