float quantity(vec3 wo, vec3 wm) { return D(wm, alpha) * max(dot(wo, wm), 0.0) / visible_area(wo, alpha); }
