// Slot seeding: of a model that draws no numbers of its own.
void seed_random(uint pass) {}

vec3 mean_f(vec3 wo, vec3 wi, int walks) { return f(wo, wi); }
