// A picture, pixel by pixel, its lower left corner at a place of the target.
uniform sampler2D picture;
uniform ivec2 corner;
out vec4 color;

void main() { color = vec4(texelFetch(picture, ivec2(gl_FragCoord.xy) - corner, 0).rgb, 1.0); }
