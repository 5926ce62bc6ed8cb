// Random numbers by pixel and pass: integers throughout, so that every driver and the twin draw the same ones.

// The streams of a pixel, each two dimensions of one sequence in six.
const uint STREAM_PIXEL = 0u;  // place in the pixel
const uint STREAM_BSDF = 1u;   // direction drawn from the BSDF
const uint STREAM_LIGHT = 2u;  // direction drawn from the light

// Steps of a Kronecker sequence by stream: the fractions of 2 cos(2 pi k / 17), k = 2 4, 1 6, 5 7, as odd multiples of
// 2^-32. They belong to an algebraic field of degree 8: no combination with small whole numbers comes near a whole
// number, so that the points of a stream spread evenly, and so do those of two or three together (Hua and Wang 1981,
// "Applications of Number Theory to Numerical Analysis"; of the pairings tried, this one errs least). Powers of one
// number, as in the sequences R_d, do worse: one of the six of R_6 is 15/23 to 9e-6.
const uvec2 STEPS[3] =
    uvec2[3](uvec2(2053070967u, 792579173u), uvec2(3714908163u, 3413342483u), uvec2(1944220111u, 1286625007u));

// Hash of three numbers to three: pcg3d of Jarzynski and Olano 2020, "Hash Functions for GPU Rendering", JCGT 9(3).
uvec3 pcg3d(uvec3 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v ^= v >> 16u;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  return v;
}

// The highest 24 bits as a number in [0, 1): float32 holds no more of them, and rounding all 32 could give 1.
vec2 unit_interval(uvec2 bits) { return vec2(bits >> 8u) * (1.0 / 16777216.0); }
vec3 unit_interval(uvec3 bits) { return vec3(bits >> 8u) * (1.0 / 16777216.0); }

// State of the generator of formulas that draw numbers of their own. Views seed it by pixel and pass (views/seeding_pixel.glsl).
uvec3 random_state = uvec3(0u);

// Three numbers in [0, 1), others at each call.
vec3 drawn() {
  random_state = pcg3d(random_state);
  return unit_interval(random_state);
}

// A third number from a point of the unit square: for a sampler that takes two and has one decision more to make. It is the
// point's hash, so that it shares no pattern with the two.
float third(vec2 u) {
  return unit_interval(pcg3d(uvec3(uvec2(u * 16777216.0), 0u)).xy).x;
}

// Point `index` in the unit square, by pixel and stream: the sequence rotated by the pixel's hash (Cranley and Patterson
// 1976), in fixed point, which wraps exactly for every index.
vec2 random2(uvec2 pixel, uint index, uint stream) {
  return unit_interval(pcg3d(uvec3(pixel, stream)).xy + index * STEPS[stream]);
}
