// Slot facets: the integral over facets whose normals follow Trowbridge and Reitz. On the sphere of the normals stretched by 1 / alpha
// their density is even, so its nodes need no other scale.
#include "lib/ndf_ggx.glsl"

const float NODE_SCALE = 1.0;

#include "lib/facets.glsl"
