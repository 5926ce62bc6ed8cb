float quantity(float f, vec3 wi) { return f * abs(wi.z); }
