// Radiance that the surface sends to the eye from one directional light.
uniform vec3 light;  // direction to it
uniform float irradiance;

vec3 radiance_directional(vec3 wo, mat3 frame) {
  vec3 wi = light * frame;
  return f(wo, wi) * (max(wi.z, 0.0) * irradiance);
}
