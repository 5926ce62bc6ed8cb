// Colour maps, sRGB: viridis (Smith and van der Walt 2015, CC0) as 17 of its colours joined linearly, off by at most 0.0225;
// and RdBu of ColorBrewer (Brewer 2002, Apache 2.0), 11 colours joined linearly, for values of both signs.
const vec3 VIRIDIS[17] = vec3[17](
    vec3(0.2670, 0.0049, 0.3294), vec3(0.2823, 0.0946, 0.4170), vec3(0.2789, 0.1749, 0.4830),
    vec3(0.2593, 0.2507, 0.5244), vec3(0.2302, 0.3213, 0.5455), vec3(0.2000, 0.3864, 0.5545),
    vec3(0.1733, 0.4474, 0.5579), vec3(0.1497, 0.5064, 0.5573), vec3(0.1281, 0.5651, 0.5509),
    vec3(0.1203, 0.6238, 0.5343), vec3(0.1554, 0.6815, 0.5032), vec3(0.2415, 0.7366, 0.4545),
    vec3(0.3629, 0.7867, 0.3866), vec3(0.5081, 0.8292, 0.2992), vec3(0.6694, 0.8622, 0.1954),
    vec3(0.8359, 0.8861, 0.1025), vec3(0.9932, 0.9062, 0.1439));

const vec3 RDBU[11] = vec3[11](
    vec3(0.0196, 0.1882, 0.3804), vec3(0.1294, 0.4000, 0.6745), vec3(0.2627, 0.5765, 0.7647),
    vec3(0.5725, 0.7725, 0.8706), vec3(0.8196, 0.8980, 0.9412), vec3(0.9686, 0.9686, 0.9686),
    vec3(0.9922, 0.8588, 0.7804), vec3(0.9569, 0.6471, 0.5098), vec3(0.8392, 0.3765, 0.3020),
    vec3(0.6980, 0.0941, 0.1686), vec3(0.4039, 0.0000, 0.1216));

vec3 viridis(float x) {
  float place = clamp(x, 0.0, 1.0) * 16.0;
  int i = min(int(place), 15);
  return mix(VIRIDIS[i], VIRIDIS[i + 1], place - float(i));
}

// Blue for -1, nearly white for 0, red for 1.
vec3 diverging(float x) {
  float place = clamp(0.5 * x + 0.5, 0.0, 1.0) * 10.0;
  int i = min(int(place), 9);
  return mix(RDBU[i], RDBU[i + 1], place - float(i));
}
