// Evaluates one function over a table: a row is a pixel, an argument is a texture.
#include "chunk.glsl"
#include "call.glsl"
