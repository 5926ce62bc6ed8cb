// Slot random: of a model that draws no numbers of its own.
void seed_random(uint pass) {}
