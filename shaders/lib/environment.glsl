// Light from all around, as a lat-long map: y is up, the middle column at -z, columns run towards +x, row 0 on top.
//
// `map` holds the radiance at the texels' centres in rgb, and in a the density per solid angle of sample_environment,
// which is constant over a texel. `cdf` are the cumulative sums by which a random number finds its texel, in units
// of 2^-24: integers that float32 holds exactly and that random numbers of 24 bits meet exactly, so that the density
// is the sampler's own, without rounding. Its row j < height has a step for each column of row j of the map, its row
// `height` one for each row of the map, in its first `height` columns: r and g are the sums before and after the step,
// b and a the first and the last step that a number can lie in when its place in the row, of `count` equal ones, is
// here (Chen and Asau 1974, "On Generating Random Variates from an Empirical Distribution"). Neither texture is
// filtered by the hardware, whose weights have 8 bits on many a GPU.
#include "lib/common.glsl"
#include "lib/transcendental.glsl"

// Place in the map, in [0, 1]^2, of the direction w.
vec2 environment_uv(vec3 w) {
  return vec2(0.5 + atan2_precise(w.x, -w.z) / TWO_PI, atan2_precise(length(w.xz), w.y) / PI);
}

// Direction at the longitude u in [0, 1] where s = sin^2(theta / 2) and c = cos^2(theta / 2). Area grows as s, and as
// both are given, neither pole suffers from cancellation.
vec3 environment_direction(float u, float s, float c) {
  float phi = TWO_PI * (u - 0.5);
  float r = 2.0 * sqrt(s * c);
  return vec3(r * sin(phi), c - s, -r * cos(phi));
}

// Along w: in rgb the radiance, bilinear between the texels' centres, where columns wrap and rows end at the poles; in
// a the density of sample_environment per solid angle, above 0 wherever the radiance is.
vec4 environment_lookup(sampler2D map, vec3 w) {
  ivec2 size = textureSize(map, 0);
  vec2 place = environment_uv(w) * vec2(size) - 0.5;
  vec2 corner = floor(place);
  vec2 t = place - corner;
  int left = (int(corner.x) + size.x) % size.x;
  int right = (left + 1) % size.x;
  int top = max(int(corner.y), 0);
  int bottom = min(int(corner.y) + 1, size.y - 1);
  vec4 a = texelFetch(map, ivec2(left, top), 0);
  vec4 b = texelFetch(map, ivec2(right, top), 0);
  vec4 c = texelFetch(map, ivec2(left, bottom), 0);
  vec4 d = texelFetch(map, ivec2(right, bottom), 0);
  vec2 nearest = t.x < 0.5 ? vec2(a.a, c.a) : vec2(b.a, d.a);
  a += t.x * (b - a);  // not mix, whose weights' sum may round: a map of ones gives exactly 1
  c += t.x * (d - c);
  return vec4((a + t.y * (c - a)).rgb, t.y < 0.5 ? nearest.x : nearest.y);
}

vec3 environment_radiance(sampler2D map, vec3 w) { return environment_lookup(map, w).rgb; }

float pdf_environment(sampler2D map, vec3 w) { return environment_lookup(map, w).a; }

// The step in a row of `count` that x, a whole number below 2^24, lies in; sets the place within it, in (0, 1).
int environment_step(sampler2D cdf, int row, int count, float x, out float t) {
  vec2 range = texelFetch(cdf, ivec2(int(x) / ((16777215 + count) / count), row), 0).ba;
  int low = int(range.x);
  int high = int(range.y);
  int found = (low + high) / 2;
  vec2 sums = texelFetch(cdf, ivec2(found, row), 0).rg;
  while (low < high && (x < sums.x || x >= sums.y)) {
    if (x < sums.x) high = found - 1;
    else low = found + 1;
    found = (low + high) / 2;
    sums = texelFetch(cdf, ivec2(found, row), 0).rg;
  }
  float past = float(int(x) - int(sums.x));  // not x - sums.x + 0.5, which compilers regroup and then round
  t = (past + 0.5) / (sums.y - sums.x);
  return found;
}

// Direction in proportion to the luminance of the radiance averaged over each texel, uniform by area within the texel;
// sets its density per solid angle. Inversion, rows by u.y and then columns by u.x: it keeps the points' even spread.
vec3 sample_environment(sampler2D map, sampler2D cdf, vec2 u, out float pdf) {
  ivec2 size = textureSize(map, 0);
  vec2 x = floor(u * 16777216.0);
  vec2 t;
  int row = environment_step(cdf, size.y, size.y, x.y, t.y);
  int column = environment_step(cdf, row, size.x, x.x, t.x);
  pdf = texelFetch(map, ivec2(column, row), 0).a;
  vec2 half_theta = 0.5 * PI * vec2(float(row), float(row + 1)) / float(size.y);
  vec2 s = sin(half_theta);
  vec2 c = cos(half_theta);
  s *= s;
  c *= c;
  return environment_direction((float(column) + t.x) / float(size.x), s.x + t.y * (s.y - s.x), c.x + t.y * (c.y - c.x));
}
