// A quantity of the model over the directions to the light.
#include "models/{model}.glsl"
#include "views/seeding_{seeding}.glsl"

uniform int walks;  // of a stochastic f, whose mean is taken

#include "views/hemisphere_wi_{of_wi}.glsl"
#include "views/lobe_{radius}.glsl"
#include "views/hemisphere.glsl"
