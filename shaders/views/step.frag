// One step of a walk over a microsurface of mirrors a pixel, without the loop: what a facet that is met costs at least.
#include "lib/common.glsl"
#include "lib/microfacet.glsl"
#include "lib/ndf_{ndf}.glsl"
#include "lib/sampling_{ndf}_caps.glsl"
#include "lib/walk_{ndf}.glsl"
#include "lib/fresnel_{fresnel}.glsl"
#include "lib/random.glsl"
#include "lib/walk.glsl"

uniform vec2 size;
uniform vec2 alpha;
uniform vec3 eta;
uniform vec3 k;
out vec4 color;

void main() {
  random_state = uvec3(uvec2(gl_FragCoord.xy), 1u);
  vec2 p = gl_FragCoord.xy / size - 0.5;
  vec3 wo = normalize(vec3(p, p.x));
  vec3 wi = normalize(vec3(-p.y, p.x, 0.6));
  float area = projected_area(wo, alpha);
  float share = D(wi + wo, alpha) / (4.0 * area) * passage(p.y + 0.5, -wo, area, wi, p.x + 0.5);
  vec3 u = drawn();
  vec3 wm = sample_wm(wo, u.yz, alpha);
  vec3 weight = F(clamp(dot(wo, wm), 0.0, 1.0), eta, k);
  color = vec4(weight * F(cos_facet(wo, wi), eta, k) * share, flight(p.y + 0.5, -wo, area, u.xy) + mirror(wo, wm).z);
}
