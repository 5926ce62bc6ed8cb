// Slot lighting: none.
vec3 radiance(vec3 wo, mat3 frame) { return vec3(0.0); }
