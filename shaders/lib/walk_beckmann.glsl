// Slot walk: of Beckmann, for directions above and below the horizon.
#include "lib/beckmann.glsl"

// Area of the facets visible from w, projected along w: |w.z (1 + Lambda(w))|, the integral of D (w . wm)+.
float projected_area(vec3 w, vec2 alpha) { return max(w.z, 0.0) + z_Lambda_beckmann(vec3(w.xy, abs(w.z)), alpha); }
