// One quad around each segment of a polyline. A texel of `points` is x, y in pixels from the bottom left, and 0 where a new
// polyline begins.
uniform sampler2D points;
uniform vec2 size;    // of the target, pixels
uniform float width;  // of the line, pixels
flat out vec2 from;
flat out vec2 to;

void main() {
  vec3 a = texelFetch(points, ivec2(gl_InstanceID, 0), 0).xyz;
  vec3 b = texelFetch(points, ivec2(gl_InstanceID + 1, 0), 0).xyz;
  from = a.xy;
  to = b.xy;
  vec2 along = b.xy - a.xy;
  float reach = length(along);
  along = reach > 0.0 ? along / reach : vec2(1.0, 0.0);
  int corner = gl_VertexID < 3 ? gl_VertexID : gl_VertexID - 2;
  float end = float(corner & 1);
  float side = float(corner >> 1) * 2.0 - 1.0;
  float margin = 0.5 * width + 1.0;
  vec2 position = mix(a.xy, b.xy, end) + margin * ((end * 2.0 - 1.0) * along + side * vec2(-along.y, along.x));
  gl_Position = b.z == 0.0 ? vec4(2.0, 2.0, 2.0, 1.0) : vec4(position / size * 2.0 - 1.0, 0.0, 1.0);
}
