// Slot body: a solid ball of the medium below the surface, with the light of the scene around it. A ray that enters goes straight on
// to where it meets the surface from inside, which reflects or transmits it by the same model, and so on up to MEETINGS times; what
// is left then is lost. One path a pass; at each meeting the light from outside counts as on an opaque sphere.
#include "views/random_ball.glsl"

const uint MEETINGS = 16u;

vec3 radiance(vec3 wo, mat3 frame);

// Radiance to the eye, at (0, 0, 1), from the place of that normal.
vec3 seen(vec3 normal) {
  vec3 eye = vec3(0.0, 0.0, 1.0);
  vec3 share = vec3(1.0);
  vec3 sum = vec3(0.0);
  for (meeting = 0u; meeting < MEETINGS; ++meeting) {
    mat3 frame = frame_at(normal);
    vec3 wo = eye * frame;
    sum += share * radiance(wo, frame);
    vec3 wi;
    share *= sample_f(wo, random(STREAM_BSDF), wi);  // the direction that radiance counts if it leads out
    if (wi.z >= 0.0 || share == vec3(0.0)) break;
    eye = -(frame * wi);
    normal = normalize(normal - 2.0 * dot(eye, normal) * eye);
  }
  return sum;
}
