// Slot fresnel_mean: all light is reflected.
vec3 F_mean(vec3 eta, vec3 k) { return vec3(1.0); }
