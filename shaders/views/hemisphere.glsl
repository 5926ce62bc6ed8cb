// A quantity over the hemisphere of directions as a disc of radius 1, equal in area: Lambert's azimuthal projection,
// r = sqrt(2) sin(theta / 2), on which 1 of area is 2 sr everywhere. Coloured by its share of the largest value.
#include "lib/colormap.glsl"

uniform vec3 wo;
uniform float up;       // 1 above the surface, -1 below it
uniform vec2 size;      // of the picture, pixels
uniform vec2 middle;    // of the picture, on the disc
uniform float pixel;    // side of a pixel on the disc
uniform vec2 peak;      // where the largest value is, on the disc
uniform float share;    // 1 / largest value
uniform float decades;  // below it that a logarithmic scale shows
uniform vec3 paper;
out vec4 color;

void main() {
  vec2 p = middle + pixel * (gl_FragCoord.xy - 0.5 * size);
  float coverage = clamp((1.0 - length(p)) / pixel + 0.5, 0.0, 1.0);
  p += clamp(peak - p, -0.5 * pixel, 0.5 * pixel);  // so a lobe thinner than a pixel does not fall between two
  p /= max(length(p) / (1.0 - 1e-6), 1.0);
  float r2 = dot(p, p);
  float value = quantity(wo, vec3(p * sqrt(2.0 - r2), up * (1.0 - r2)));
  bool wrong = isnan(value) || isinf(value);
  color = vec4(mix(paper, wrong ? vec3(1.0, 0.0, 1.0) : viridis(radius(value * share, decades)), coverage), 1.0);
}
