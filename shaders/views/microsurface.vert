// A corner of a block whose top is a height field. The outermost corners repeat the field's edge at the foot: its walls.
uniform sampler2D field;  // height, share that is lit, share that is seen; rows along u
uniform float pitch;      // between heights
uniform float foot;       // height of the block's foot
uniform vec3 right;       // the camera's axes
uniform vec3 up;
uniform vec3 eye;
uniform vec2 center;  // where the middle of the block lies, in units of the target's half size
uniform vec2 unit;    // a length of 1, in the same units
uniform float depth;  // 1 over the block's reach
out vec3 normal;
out vec2 share;  // lit, seen
out float wall;  // 0 on the height field alone

vec4 corner(ivec2 at) { return texelFetch(field, clamp(at, ivec2(0), textureSize(field, 0) - 1), 0); }

void main() {
  ivec2 count = textureSize(field, 0);
  ivec2 at = ivec2(gl_VertexID % (count.x + 2), gl_VertexID / (count.x + 2)) - 1;
  ivec2 inside = clamp(at, ivec2(0), count - 1);
  bool edge = at != inside;
  vec4 here = corner(inside);
  // twice the pitch even at the field's edge, where the slope is half as steep: on walls it is not looked at
  vec2 rise = vec2(corner(inside + ivec2(1, 0)).x - corner(inside - ivec2(1, 0)).x,
                   corner(inside + ivec2(0, 1)).x - corner(inside - ivec2(0, 1)).x);
  normal = normalize(vec3(-rise, 2.0 * pitch));
  share = here.yz;
  wall = edge ? 1.0 : 0.0;
  vec3 p = vec3((vec2(inside) - 0.5 * vec2(count - 1)) * pitch, edge ? foot : here.x);
  gl_Position = vec4(center + unit * vec2(dot(right, p), dot(up, p)), -depth * dot(eye, p), 1.0);
}
