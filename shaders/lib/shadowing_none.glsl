// Slot shadowing: none. Creates energy at grazing angles without bound; a lesson, not a model.
float G2(vec3 wo, vec3 wi, float Lambda_o, float Lambda_i) { return 1.0; }
