// By how much the luminance of one picture differs from another's, in colours: blue where it is darker, red where brighter,
// magenta where that is no finite number.
#include "lib/colormap.glsl"
#include "lib/srgb.glsl"

uniform sampler2D picture;  // both linear, premultiplied by coverage
uniform sampler2D reference;
uniform float share;    // 1 over the difference that has the last colour
uniform vec3 backdrop;  // sRGB
out vec4 color;

// By its bits: a compiler that trusts all numbers to be finite may drop isnan and isinf.
bool no_number(float x) { return (floatBitsToUint(x) & 0x7fffffffu) >= 0x7f800000u; }

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 one = texelFetch(picture, at, 0);
  vec4 other = texelFetch(reference, at, 0);
  float difference = luminance(one.rgb - other.rgb) * share;
  if (no_number(difference)) {
    color = vec4(1.0, 0.0, 1.0, 1.0);
    return;
  }
  color = vec4(mix(backdrop, diverging(other.a > 0.0 ? difference / other.a : 0.0), other.a), 1.0);
}
