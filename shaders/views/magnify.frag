// A small drawing of a sphere as large as the sphere is here, with an edge of this size.
uniform sampler2D picture;
uniform float pixels;  // along a side that one of the small drawing stands for
uniform vec2 center;   // pixels
uniform float radius;  // pixels
out vec4 color;

void main() {
  float coverage = clamp(radius + 0.5 - distance(gl_FragCoord.xy, center), 0.0, 1.0);
  color = texture(picture, gl_FragCoord.xy / (pixels * vec2(textureSize(picture, 0))));
  color *= color.a > 0.0 ? coverage / color.a : 0.0;
}
