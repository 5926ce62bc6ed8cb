// A sphere under an orthographic eye at +z: one ray a pixel and pass, its normal in closed form.
#include "models/{model}.glsl"
#include "views/seeding_{seeding}.glsl"

uniform vec2 center;   // pixels
uniform float radius;  // pixels
uniform vec2 jitter;   // of the ray within its pixel
uniform float share;   // of this pass in the running mean; 1 for the first, which writes coverage instead
uniform uint pass;
out vec4 color;

// The surface's frame where its normal is this one: along the parallels, the meridians, and the normal.
mat3 frame_at(vec3 normal) {
  vec3 tangent = normalize(vec3(normal.z, 0.0, -normal.x));
  return mat3(tangent, cross(normal, tangent), normal);
}

#include "views/body_{body}.glsl"
#include "views/sphere_{lighting}.glsl"

void main() {
  float coverage = clamp(radius + 0.5 - distance(gl_FragCoord.xy, center), 0.0, 1.0);
  color = vec4(0.0);
  if (coverage == 0.0) return;
  seed_random(pass);
  vec2 p = (gl_FragCoord.xy + jitter - center) / radius;
  float edge = max(1.0 - 0.5 / radius, 0.0);  // a rim's pixel shows the sphere half a pixel inside: its cosine is not 0
  float r = length(p);
  if (r > edge) {
    p *= edge / r;
    r = edge;
  }
  color = vec4(coverage * seen(vec3(p, sqrt((1.0 - r) * (1.0 + r)))), share < 1.0 ? share : coverage);
}
