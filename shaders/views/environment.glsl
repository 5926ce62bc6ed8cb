// Light from all around: what the estimators of the slot have in common. Each pass of each adds an estimate of the radiance that
// the surface sends to the eye, `radiance_environment`.
#include "lib/environment.glsl"
#include "views/random_{body}.glsl"

uniform sampler2D map;
uniform sampler2D cdf;
uniform mat3 turn;  // from the eye's frame to the map's
uniform float gain;
