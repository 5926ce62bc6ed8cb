// One evaluation of f a pixel, the directions from its place: what a material costs without its picture.
#include "models/{model}.glsl"
#include "views/seeding_{seeding}.glsl"

uniform vec2 size;
out vec4 color;

void main() {
  seed_random(0u);
  vec2 p = gl_FragCoord.xy / size - 0.5;
  color = vec4(f(normalize(vec3(p, 0.7)), normalize(vec3(-p.y, p.x, 0.6))), 1.0);
}
