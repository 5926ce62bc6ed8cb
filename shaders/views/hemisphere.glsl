// A quantity over the hemisphere of directions as a disc of radius 1, equal in area: Lambert's azimuthal projection,
// r = sqrt(2) sin(theta / 2), on which 1 of area is 2 sr everywhere.
uniform vec3 wo;
uniform float up;      // 1 above the surface, -1 below it
uniform vec2 size;     // of the picture, pixels
uniform vec2 middle;   // of the picture, on the disc
uniform float pixel;   // side of a pixel on the disc
uniform vec2 peak;     // where the largest value is, on the disc
uniform float share;   // of this pass in the running mean
out vec4 value;

void main() {
  vec2 p = middle + pixel * (gl_FragCoord.xy - 0.5 * size);
  value = vec4(0.0, 0.0, 0.0, share);
  if (length(p) > 1.0 + pixel) return;
  p += clamp(peak - p, -0.5 * pixel, 0.5 * pixel);  // so a lobe thinner than a pixel does not fall between two
  p /= max(length(p) / (1.0 - 1e-6), 1.0);
  float r2 = dot(p, p);
  value.rgb = vec3(quantity(wo, vec3(p * sqrt(2.0 - r2), up * (1.0 - r2))));
}
