// f for one viewer over a table of directions to the light.
#include "models/{model}.glsl"

uniform sampler2D directions;
uniform vec3 wo;
out vec4 value;

void main() {
  value = vec4(f(wo, texelFetch(directions, ivec2(gl_FragCoord.xy), 0).xyz), 0.0);
}
