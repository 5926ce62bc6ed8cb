// A rough surface in the sun: shadows are cast, and what is shadowed or masked has a colour of its own.
uniform vec3 light;  // towards it
uniform vec3 body;   // sRGB colours: of the surface, its walls, and facets that are shadowed, masked and both
uniform vec3 side;
uniform vec3 shadowed;
uniform vec3 masked;
uniform vec3 both;
in vec3 normal;
in vec2 share;
in float wall;
out vec4 color;

void main() {
  vec3 tint = mix(mix(both, shadowed, share.y), mix(masked, body, share.y), share.x);
  vec3 n = normalize(normal);
  float shade = mix(0.6 + 0.3 * n.z, 0.55 + 0.45 * max(dot(n, light), 0.0), share.x);
  color = vec4(wall > 0.0 ? side : tint * shade, 1.0);
}
