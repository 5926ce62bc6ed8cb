// Slot body: opaque.
vec3 radiance(vec3 wo, mat3 frame);

// Radiance to the eye, at (0, 0, 1), from the place of that normal.
vec3 seen(vec3 normal) {
  mat3 frame = frame_at(normal);
  return radiance(vec3(frame[0].z, frame[1].z, frame[2].z), frame);
}
