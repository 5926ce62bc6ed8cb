// Radiance that the surface sends to the eye from all around: each pass draws one direction from the BSDF and one from the
// map and weighs them by the balance heuristic. Veach and Guibas 1995, "Optimally Combining Sampling Techniques for Monte
// Carlo Rendering", Eq. 14.
#include "lib/environment.glsl"
#include "views/random_{body}.glsl"

uniform sampler2D map;
uniform sampler2D cdf;
uniform mat3 turn;  // from the eye's frame to the map's
uniform float gain;

vec3 radiance_environment(vec3 wo, mat3 frame) {
  vec3 wi;
  vec3 weight = sample_f(wo, random(STREAM_BSDF), wi);
  vec3 sum = vec3(0.0);
  if (wi.z > HORIZON) {
    vec4 seen = environment_lookup(map, turn * (frame * wi));  // radiance, and the other sampler's density
    float own = pdf(wo, wi);
    sum += weight * seen.rgb * (own / (own + seen.a));
  }
  float other;
  vec3 world = sample_environment(map, cdf, random(STREAM_LIGHT), other);
  wi = (world * turn) * frame;
  if (wi.z > 0.0) sum += f(wo, wi) * environment_radiance(map, world) * (wi.z / (other + pdf(wo, wi)));
  return gain * sum;
}
