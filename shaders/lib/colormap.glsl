// The colour map viridis (Smith and van der Walt 2015, CC0) as 17 of its colours joined linearly; sRGB. Off by at most 0.0225.
const vec3 VIRIDIS[17] = vec3[17](
    vec3(0.2670, 0.0049, 0.3294), vec3(0.2823, 0.0946, 0.4170), vec3(0.2789, 0.1749, 0.4830),
    vec3(0.2593, 0.2507, 0.5244), vec3(0.2302, 0.3213, 0.5455), vec3(0.2000, 0.3864, 0.5545),
    vec3(0.1733, 0.4474, 0.5579), vec3(0.1497, 0.5064, 0.5573), vec3(0.1281, 0.5651, 0.5509),
    vec3(0.1203, 0.6238, 0.5343), vec3(0.1554, 0.6815, 0.5032), vec3(0.2415, 0.7366, 0.4545),
    vec3(0.3629, 0.7867, 0.3866), vec3(0.5081, 0.8292, 0.2992), vec3(0.6694, 0.8622, 0.1954),
    vec3(0.8359, 0.8861, 0.1025), vec3(0.9932, 0.9062, 0.1439));

vec3 viridis(float x) {
  float place = clamp(x, 0.0, 1.0) * 16.0;
  int i = min(int(place), 15);
  return mix(VIRIDIS[i], VIRIDIS[i + 1], place - float(i));
}
