// Slot diffuse: Lambert, the same radiance in all directions.
float diffuse_factor(vec3 wo, vec3 wi, float sigma) { return 1.0; }
