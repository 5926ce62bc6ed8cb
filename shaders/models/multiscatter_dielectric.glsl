// Slot facets: smooth interfaces between two dielectrics, which reflect and refract. Below the horizon is the medium of index
// eta_below; radiance is that of the viewer's side, as in models/dielectric.glsl. A ray below the surface walks as one above it does,
// mirrored through the origin: facets keep their normals, and depth is measured from the lowest facet up.
#include "lib/microfacet.glsl"
#include "lib/refraction.glsl"
#include "lib/warp.glsl"

bool counts(vec3 w) { return abs(w.z) > HORIZON; }

// The index of the other side over that of w.
float eta_seen(vec3 w) {
  float eta = apart_from_one(material.eta_below);
  return w.z > 0.0 ? eta : 1.0 / eta;
}

// w as seen with wo above the surface.
vec3 turned(vec3 w, vec3 wo) { return vec3(w.xy, wo.z > 0.0 ? w.z : -w.z); }

// Of facets that refract w, on their upper side, to wt, on their lower one: T D cos cos / L^2. Walter et al. 2007, Eq. 21. Over
// w's projected area it is the density of the way back, and times eta^2 that of this way.
float passing(vec3 w, vec3 wt, float eta) {
  vec3 sum = sum_refracted(w, wt, eta);
  vec3 wm = eta > 1.0 ? -sum : sum;
  float L = length(sum);
  if (wm.z <= 0.0 || L <= 0.0) return 0.0;
  vec2 c = cos_refracted(L, eta);
  if (c.x <= 0.0 || c.y <= 0.0) return 0.0;
  return T_dielectric(c.x, c.y, eta) * (c.x / L) * (c.y / L) * D(wm, material.alpha);
}

float mirroring(vec3 w, vec3 wi, float eta) {
  return 0.25 * F_dielectric(cos_facet(w, wi), eta) * D(w + wi, material.alpha);
}

// As of mirrors, with what is refracted by the depth that was drawn. It begins at either end, as there.
vec3 walk(vec3 wo, vec3 wi) {
  bool swap = drawn().x < 0.5;
  vec3 from = swap ? wi : wo;
  vec3 to = swap ? wo : wi;
  float eta = eta_seen(from);
  // light goes from the viewer's side: over n^2 of its own
  float scale = wo.z * wi.z < 0.0 ? (swap ? 1.0 : 1.0 / (eta * eta)) : 1.0;
  to = turned(to, from);
  vec3 w = -turned(from, from);
  float hidden = projected_area(vec3(to.xy, -abs(to.z)), material.alpha);
  float back = abs(to.z) + hidden;
  float depth = 0.0, outer = 0.0, sum = 0.0;
  int last = last_order();
  for (int order = 1; order <= last; ++order) {
    float area = projected_area(-w, material.alpha);
    if (area <= CLEAR * w.z) break;
    float next = flight(depth, w, area, drawn().xy);
    bool stays = to.z > 0.0;
    float density = order < material.first || (!stays && next < 0.0) ? 0.0 : stays ? mirroring(-w, to, eta) : passing(-w, to, eta);
    if (density > 0.0) {
      float share = stays ? passage(depth, w, area, to, hidden) * density / area
                          : exp_precise(-depth_below(next) * hidden / abs(to.z)) / abs(to.z) * density * eta * eta / area;
      if (order > 1) share *= 2.0 * outer / (outer + density / back);
      sum += share;
    }
    if (order == last || next < 0.0) break;
    vec3 u = drawn();
    vec3 wm = sample_wm(-w, u.yz, material.alpha);
    if (u.x < F_dielectric(clamp(dot(-w, wm), 0.0, 1.0), eta)) {
      vec3 reflected = mirror(-w, wm);
      if (order == 1) outer = mirroring(-w, reflected, eta) / area;
      w = reflected;
      depth = next;
    } else {
      vec3 wt = refracted(-w, wm, eta);
      if (order == 1) outer = passing(-w, wt, eta) * eta * eta / area;
      w = -wt;
      depth = depth_below(next);
      to = -to;
      eta = 1.0 / eta;
    }
  }
  return vec3(scale * sum);
}

// Chance of the cosine lobes, one on each side, for light that met more than one facet; in 32nds, as of mirrors.
float broad() { return ceil(16.0 * max(material.alpha.x, material.alpha.y)) / 32.0; }

float pdf_lobes(vec3 wo, vec3 wi) {
  vec3 o = turned(wo, wo);
  vec3 i = turned(wi, wo);
  float eta = eta_seen(wo);
  float area = projected_area(o, material.alpha);
  float one = (i.z > 0.0 ? mirroring(o, i, eta) : eta * eta * passing(o, i, eta)) / area;
  return mix(one, 0.5 * INV_PI * abs(wi.z), broad());
}

// A direction that ends on the wrong side of the surface is lost: it is put on the horizon.
vec3 sample_lobes(vec3 wo, vec2 u) {
  float share = broad();
  float side = third(u);
  if (u.x < share) {
    vec3 w = cosine_hemisphere(vec2(u.x / share, u.y));
    return vec3(w.xy, side < 0.5 ? w.z : -w.z);
  }
  vec3 o = turned(wo, wo);
  float eta = eta_seen(wo);
  vec3 wm = sample_wm(o, vec2((u.x - share) / (1.0 - share), u.y), material.alpha);
  bool reflects = side < F_dielectric(clamp(dot(o, wm), 0.0, 1.0), eta);
  vec3 w = reflects ? mirror(o, wm) : refracted(o, wm, eta);
  return turned(vec3(w.xy, reflects ? max(w.z, 0.0) : min(w.z, 0.0)), wo);
}
