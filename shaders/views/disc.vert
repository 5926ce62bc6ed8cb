// A fan of triangles around a disc, a pixel larger: what lies outside costs nothing.
#include "lib/common.glsl"

uniform vec2 size;    // of the target, pixels
uniform vec2 center;  // pixels
uniform float radius;
uniform float sides;

void main() {
  int corner = gl_VertexID % 3;
  float turn = float(gl_VertexID / 3 + corner - 1) * (TWO_PI / sides);
  float reach = corner == 0 ? 0.0 : (radius + 1.0) / cos(PI / sides);
  gl_Position = vec4((center + reach * vec2(cos(turn), sin(turn))) / size * 2.0 - 1.0, 0.0, 1.0);
}
