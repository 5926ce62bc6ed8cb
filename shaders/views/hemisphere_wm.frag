// A density of facets over their normals.
#include "lib/ndf_{ndf}.glsl"

uniform vec2 alpha;

#include "views/hemisphere_wm_{of_wm}.glsl"
#include "views/hemisphere.glsl"
