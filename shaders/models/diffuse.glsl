// Diffuse reflection: the slot's law, diffuse_f, in 1/sr. Leaves out light that leaves the body elsewhere.
#include "params.glsl"
#include "lib/common.glsl"
#include "lib/diffuse_{diffuse}.glsl"
#include "lib/warp.glsl"

vec3 f(vec3 wo, vec3 wi) {
  if (wo.z <= HORIZON || wi.z <= HORIZON) return vec3(0.0);
  return diffuse_f(wo, wi, material.albedo, material.sigma, material.r);
}

float pdf(vec3 wo, vec3 wi) {
  if (wo.z <= HORIZON || wi.z <= HORIZON) return 0.0;
  return INV_PI * wi.z;
}

vec3 sample_f(vec3 wo, vec2 u, out vec3 wi) {
  wi = cosine_hemisphere(u);
  return PI * f(wo, wi);
}
