// Slot facets: diffuse, of a given albedo: Lambert's law about each facet's own normal.
#include "lib/warp.glsl"

bool counts(vec3 w) { return w.z > HORIZON; }

vec3 walk(vec3 wo, vec3 wi) {
  float hidden = projected_area(-wi, material.alpha);
  vec3 w = -wo, weight = vec3(1.0), sum = vec3(0.0);
  float depth = 0.0;
  int last = last_order();
  for (int order = 1; order <= last; ++order) {
    float area = projected_area(-w, material.alpha);
    if (area <= CLEAR * w.z) break;
    vec3 u = drawn();
    float next = flight(depth, w, area, u.xy);
    if (next < 0.0) break;
    vec3 wm = sample_wm(-w, u.yz, material.alpha);
    weight *= material.albedo;
    // the mean over the flights that meet a facet
    float share = passage(depth, w, area, wi, hidden) / meets(depth, w, area);
    if (order >= material.lowest) sum += weight * (INV_PI * max(dot(wi, wm), 0.0) * share);
    depth = next;
    w = mirror(cosine_hemisphere(drawn().xy), normalize(wm + vec3(0.0, 0.0, 1.0)));  // which turns +z to wm
  }
  return sum;
}

float pdf_lobes(vec3 wo, vec3 wi) { return INV_PI * wi.z; }

vec3 sample_lobes(vec3 wo, vec2 u) { return cosine_hemisphere(u); }
