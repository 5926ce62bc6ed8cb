// The colours of the map from bottom to top.
#include "lib/colormap.glsl"

uniform vec4 box;  // left, bottom, right, top, pixels
out vec4 color;

void main() {
  vec2 at = gl_FragCoord.xy;
  vec2 inside = clamp(min(at - box.xy, box.zw - at) + 0.5, 0.0, 1.0);
  color = vec4(viridis((at.y - box.y) / (box.w - box.y)), inside.x * inside.y);
}
