// Slot facets: smooth interfaces between two dielectrics, which reflect and refract. Below the horizon is the medium of index
// eta_below; radiance is that of the viewer's side, as in models/dielectric.glsl. A ray below the surface walks as one above it does,
// mirrored through the origin: facets keep their normals, and depth is measured from the lowest facet up.
#include "lib/microfacet.glsl"
#include "lib/refraction.glsl"
#include "lib/warp.glsl"

bool counts(vec3 w) { return abs(w.z) > HORIZON; }

// The index of the other side over that of a ray above the surface, or below it.
float eta_seen(bool above) {
  float eta = apart_from_one(material.eta_below);
  return above ? eta : 1.0 / eta;
}

// n^2 of the side.
float dense(bool above) {
  float eta = apart_from_one(material.eta_below);
  return above ? 1.0 : eta * eta;
}

// w as seen with wo above the surface.
vec3 turned(vec3 w, vec3 wo) { return vec3(w.xy, wo.z > 0.0 ? w.z : -w.z); }

// Of facets that refract w, on their side `above` or not, to wt: T D cos cos / L^2, the same for the way back. Over w's projected
// area and times n^2 of the other side it is a density. Walter et al. 2007, Eq. 21.
float passing(vec3 w, vec3 wt, bool above) {
  float eta = apart_from_one(material.eta_below);
  vec3 sum = above ? sum_refracted(w, wt, eta) : sum_refracted(wt, w, eta);
  vec3 wm = (eta > 1.0) == above ? -sum : sum;
  float share = T_spread(wm, eta);
  return share > 0.0 ? share * D(wm, material.alpha) : 0.0;
}

float mirroring(vec3 w, vec3 wi, bool above) {
  return 0.25 * F_dielectric(cos_facet(w, wi), eta_seen(above)) * D(w + wi, material.alpha);
}

// As of mirrors, with what is refracted by the depth that was drawn. It begins at either end, as there.
vec3 walk(vec3 wo, vec3 wi) {
  bool swap = drawn().x < 0.5;
  vec3 from = swap ? wi : wo;
  bool above = from.z > 0.0;
  vec3 to = turned(swap ? wo : wi, from);
  vec3 w = -turned(from, from);
  float height = abs(to.z);
  float hidden = projected_area(vec3(to.xy, -height), material.alpha);
  float depth = 0.0, outer = 0.0, sum = 0.0;
  int last = last_order();
  for (int order = 1; order <= last; ++order) {
    float area = projected_area(-w, material.alpha);
    if (area <= CLEAR * w.z) break;
    float next = flight(depth, w, area, drawn().xy);
    float density = 0.0, share = 0.0;
    if (order >= material.lowest && to.z > 0.0) {
      density = mirroring(-w, to, above);
      share = passage(depth, w, area, to, hidden);
    } else if (order >= material.lowest && next >= 0.0) {
      density = passing(-w, to, above);
      share = exp_precise(-depth_below(next) * hidden / height) / height * dense(!above);
    }
    if (density > 0.0) {
      share *= density / area;
      if (order > 1) share *= 2.0 * outer / (outer + density * (to.z > 0.0 ? 1.0 : dense(above)) / (height + hidden));
      sum += share;
    }
    if (order == last || next < 0.0) break;
    vec3 u = drawn();
    vec3 wm = sample_wm(-w, u.yz, material.alpha);
    if (u.x < F_dielectric(clamp(dot(-w, wm), 0.0, 1.0), eta_seen(above))) {
      vec3 reflected = mirror(-w, wm);
      if (order == 1) outer = mirroring(-w, reflected, above) / area;
      w = reflected;
      depth = next;
    } else {
      vec3 wt = refracted(-w, wm, eta_seen(above));
      if (order == 1) outer = passing(-w, wt, above) * dense(!above) / area;
      w = -wt;
      depth = depth_below(next);
      to = -to;
      above = !above;
    }
  }
  // what arrives at wi of light from wo is f(wi, wo): f(wo, wi) has n^2 of the viewer's side and not of the light's
  return vec3(sum * (swap ? 1.0 : dense(wo.z > 0.0) / dense(wi.z > 0.0)));
}

// Chance of the cosine lobes, one on each side, for light that met more than one facet; in 32nds, as of mirrors.
float broad() { return ceil(16.0 * max(material.alpha.x, material.alpha.y)) / 32.0; }

float pdf_lobes(vec3 wo, vec3 wi) {
  vec3 o = turned(wo, wo);
  vec3 i = turned(wi, wo);
  bool above = wo.z > 0.0;
  float one = i.z > 0.0 ? mirroring(o, i, above) : dense(!above) * passing(o, i, above);
  return mix(one / projected_area(o, material.alpha), 0.5 * INV_PI * abs(wi.z), broad());
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
  float eta = eta_seen(wo.z > 0.0);
  vec3 wm = sample_wm(o, vec2((u.x - share) / (1.0 - share), u.y), material.alpha);
  bool reflects = side < F_dielectric(clamp(dot(o, wm), 0.0, 1.0), eta);
  vec3 w = reflects ? mirror(o, wm) : refracted(o, wm, eta);
  return turned(vec3(w.xy, reflects ? max(w.z, 0.0) : min(w.z, 0.0)), wo);
}
