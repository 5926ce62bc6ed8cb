// Slot facets: the integral over facets whose normals follow Beckmann. Their slopes' tail is short: on a sphere stretched by
// 1 / (1.5 alpha) they lie most evenly, which makes the error of 8 x 8 nodes a third of what it is without.
#include "lib/ndf_beckmann.glsl"

const float NODE_SCALE = 1.5;

#include "lib/facets.glsl"
