// From scene-linear radiance and coverage to sRGB colours over a backdrop. A value that is no finite number shows as magenta.
#include "lib/tonemap_{tonemap}.glsl"
#include "lib/srgb.glsl"

uniform sampler2D picture;  // premultiplied by coverage
uniform float exposure;     // factor
uniform vec3 backdrop;      // linear
out vec4 color;

// By its bits: a compiler that trusts all numbers to be finite may drop isnan and isinf.
bool no_number(vec4 x) { return any(greaterThanEqual(floatBitsToUint(x) & 0x7fffffffu, uvec4(0x7f800000u))); }

void main() {
  vec4 texel = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
  if (no_number(texel)) {
    color = vec4(1.0, 0.0, 1.0, 1.0);
    return;
  }
  vec3 display = backdrop;
  if (texel.a > 0.0) display = mix(backdrop, clamp(tonemap(texel.rgb * (exposure / texel.a)), 0.0, 1.0), texel.a);
  color = vec4(srgb_encode(display), 1.0);
}
