// The lobe's surface, shaded by its true normal under a lamp at the eye's shoulder.
#include "views/lobe_paint_{paint}.glsl"

uniform vec3 eye;
uniform vec3 lamp;
in vec3 normal;
in float height;
out vec4 color;

void main() {
  vec3 n = normalize(normal);
  if (dot(n, eye) < 0.0) n = -n;
  float shade = 0.45 + 0.55 * max(dot(n, lamp), 0.0);
  color = vec4(paint(height) * shade, 1.0);
}
