// A quantity of the model over the directions to the light.
#include "models/{model}.glsl"
#include "views/seeding_{seeding}.glsl"

uniform uint pass;

#include "views/hemisphere_wi_{of_wi}.glsl"
#include "views/hemisphere.glsl"
