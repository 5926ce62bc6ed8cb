// Share of a pixel that a line with round ends covers; the larger share is nearer.
flat in vec4 segment;
flat in vec4 ink;
flat in float width;
flat in float rank;
out vec4 color;

void main() {
  vec2 d = segment.zw - segment.xy;
  vec2 p = gl_FragCoord.xy - segment.xy;
  float t = clamp(dot(p, d) / max(dot(d, d), 1e-12), 0.0, 1.0);
  float coverage = clamp(0.5 * width + 0.5 - length(p - t * d), 0.0, 1.0);
  if (coverage == 0.0) discard;
  color = vec4(ink.rgb, 1.0) * (ink.a * coverage);
  gl_FragDepth = 1.0 - coverage * (0.9 + 0.1 * rank);
}
