// Slot gauss: the 12 nodes in [-1, 1] and weights of Gauss and Legendre's quadrature.
const vec2 GAUSS[6] = vec2[6](
    vec2(0.1252334085, 0.2491470458), vec2(0.367831499, 0.2334925365), vec2(0.5873179543, 0.2031674267),
    vec2(0.7699026742, 0.1600783285), vec2(0.9041172564, 0.106939326), vec2(0.9815606342, 0.04717533639));

const int NODES = 12;

// Node and weight, i in [0, 12).
vec2 gauss(int i) {
  vec2 right = GAUSS[i < 6 ? 5 - i : i - 6];
  return i < 6 ? vec2(-right.x, right.y) : right;
}
