// Share of a pixel that a line with round ends covers.
uniform float width;
flat in vec2 from;
flat in vec2 to;
out vec4 coverage;

void main() {
  vec2 d = to - from;
  vec2 p = gl_FragCoord.xy - from;
  float t = clamp(dot(p, d) / max(dot(d, d), 1e-12), 0.0, 1.0);
  coverage = vec4(clamp(0.5 * width + 0.5 - length(p - t * d), 0.0, 1.0));
}
