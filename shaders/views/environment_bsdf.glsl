// Slot estimator: each pass draws one direction from the BSDF. A small light is rarely met.
#include "views/environment.glsl"

vec3 radiance_environment(vec3 wo, mat3 frame) {
  vec3 wi;
  vec3 weight = sample_f(wo, random(STREAM_BSDF), wi);
  return wi.z > HORIZON ? gain * weight * environment_radiance(map, turn * (frame * wi)) : vec3(0.0);
}
