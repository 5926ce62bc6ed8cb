float quantity(vec3 wo, vec3 wm) { return D(wm, alpha); }
