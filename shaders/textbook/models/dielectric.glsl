// A rough dielectric as printed: Walter et al. 2007, Eqs. 20 and 21 with half vectors normalised and cosines as dot products, and the
// weight f cos theta_i / pdf, with no guard against a division by 0.
// In float32 the lobe of alpha = 1e-4 is off by its rounding, and next to eta = 1 nothing of it is right.
#include "params.glsl"
#include "lib/common.glsl"
#include "lib/microfacet.glsl"
#include "lib/ndf_{ndf}.glsl"
#include "lib/sampling_{ndf}_caps.glsl"
#include "lib/smith_{ndf}_exact.glsl"
#include "lib/masking_{masking}.glsl"
#include "lib/random.glsl"
#include "lib/refraction.glsl"

float eta_seen(vec3 w) { return w.z > 0.0 ? material.eta : 1.0 / material.eta; }

float G2(vec3 wo, vec3 wi) {
  float Lambda_o = Lambda(upward(wo), material.alpha);
  float Lambda_i = Lambda(upward(wi), material.alpha);
  return wo.z * wi.z > 0.0 ? G2_reflected(Lambda_o, Lambda_i) : G2_transmitted(Lambda_o, Lambda_i);
}

// T D |wo . wm| |wi . wm| / (n_i wi . wm + n_o wo . wm)^2 for n_o = 1 above, of which Eqs. 17 and 21 are made.
float passing(vec3 wo, vec3 wi) {
  vec3 above = wo.z > 0.0 ? wo : wi;
  vec3 below = wo.z > 0.0 ? wi : wo;
  vec3 wm = normalize(sum_refracted(above, below, material.eta));
  if (wm.z < 0.0) wm = -wm;
  float a = dot(above, wm);
  float b = dot(below, wm);
  if (a <= 0.0 || b >= 0.0) return 0.0;
  float sum = a + material.eta * b;
  return T_dielectric(a, -b, material.eta) * D(wm, material.alpha) * a * -b / (sum * sum);
}

vec3 f(vec3 wo, vec3 wi) {
  float area = abs(wo.z * wi.z);
  if (wo.z * wi.z < 0.0) {
    float n = wo.z > 0.0 ? 1.0 : material.eta;
    return vec3(n * n * passing(wo, wi) * G2(wo, wi) / area);
  }
  vec3 wm = normalize(upward(wo) + upward(wi));
  return vec3(D(wm, material.alpha) * G2(wo, wi) * F_dielectric(cos_facet(upward(wo), upward(wi)), eta_seen(wo)) / (4.0 * area));
}

float pdf(vec3 wo, vec3 wi) {
  vec3 o = upward(wo);
  vec3 i = upward(wi);
  float area = visible_area(o, material.alpha);
  if (wo.z * wi.z < 0.0) {
    float n = wo.z > 0.0 ? material.eta : 1.0;
    return n * n * passing(wo, wi) / area;
  }
  return F_dielectric(cos_facet(o, i), eta_seen(wo)) * D(normalize(o + i), material.alpha) / (4.0 * area);
}

vec3 sample_f(vec3 wo, vec2 u, out vec3 wi) {
  vec3 o = upward(wo);
  vec3 wm = sample_wm(o, u, material.alpha);
  bool reflects = third(u) < F_dielectric(dot(o, wm), eta_seen(wo));
  vec3 w = reflects ? mirror(o, wm) : refracted(o, wm, eta_seen(wo));
  bool lost = reflects ? w.z <= 0.0 : w.z >= 0.0;
  wi = vec3(w.xy, lost ? 0.0 : wo.z > 0.0 ? w.z : -w.z);
  if (lost) return vec3(0.0);
  return f(wo, wi) * abs(wi.z) / pdf(wo, wi);
}
