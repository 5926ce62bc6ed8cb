// Slot estimator: each pass draws one direction from the map. A narrow lobe is rarely met.
#include "views/environment.glsl"

vec3 radiance_environment(vec3 wo, mat3 frame) {
  float density;
  vec3 world = sample_environment(map, cdf, random(STREAM_LIGHT), density);
  vec3 wi = (world * turn) * frame;
  return wi.z > 0.0 ? f(wo, wi) * environment_radiance(map, world) * (gain * wi.z / density) : vec3(0.0);
}
