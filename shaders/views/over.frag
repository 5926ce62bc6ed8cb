// A share of a picture that is premultiplied by its coverage, to be blended with what is there.
uniform sampler2D picture;
uniform float share;
out vec4 color;

void main() {
  color = share * texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
}
