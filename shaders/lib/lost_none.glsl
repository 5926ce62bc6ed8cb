// Slot lost: without shadowing nothing is lost: such facets rather gain light.
float lost(vec3 w, vec2 alpha) { return 0.0; }

float lost_mean(vec2 alpha) { return 0.5; }  // only divides what is lost
