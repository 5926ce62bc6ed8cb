// One quad around each segment of a polyline. Row 0 of `points`: x and y in pixels from the bottom left, the line's rank or
// 0 where a new one begins, its width in pixels. Row 1: its colour and opacity.
uniform sampler2D points;
uniform vec2 size;      // of the target, pixels
uniform float strokes;  // above the highest rank
flat out vec4 segment;  // from, to
flat out vec4 ink;
flat out float width;
flat out float rank;  // in (0, 1)

void main() {
  vec4 a = texelFetch(points, ivec2(gl_InstanceID, 0), 0);
  vec4 b = texelFetch(points, ivec2(gl_InstanceID + 1, 0), 0);
  segment = vec4(a.xy, b.xy);
  ink = texelFetch(points, ivec2(gl_InstanceID + 1, 1), 0);
  width = b.w;
  rank = b.z / strokes;
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
