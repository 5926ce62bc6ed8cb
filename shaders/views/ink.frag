// One colour where a mask says.
uniform sampler2D mask;
uniform vec4 color;
out vec4 ink;

void main() {
  ink = vec4(color.rgb, color.a * texelFetch(mask, ivec2(gl_FragCoord.xy), 0).r);
}
