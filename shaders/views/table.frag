// f for one viewer over a table of directions to the light.
#include "models/{model}.glsl"
#include "views/seeding_{seeding}.glsl"

uniform sampler2D directions;
uniform vec3 wo;
uniform uint pass;
uniform int walks;  // of a stochastic f, whose mean is taken
out vec4 value;

void main() {
  seed_random(pass);
  value = vec4(mean_f(wo, texelFetch(directions, ivec2(gl_FragCoord.xy), 0).xyz, walks), 0.0);
}
