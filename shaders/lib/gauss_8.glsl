// Slot gauss: the 8 nodes in [-1, 1] and weights of Gauss and Legendre's quadrature.
const vec2 GAUSS[4] = vec2[4](
    vec2(0.1834346425, 0.3626837834), vec2(0.5255324099, 0.3137066459), vec2(0.7966664774, 0.2223810345),
    vec2(0.9602898565, 0.1012285363));

const int NODES = 8;

// Node and weight, i in [0, 8).
vec2 gauss(int i) {
  vec2 right = GAUSS[i < 4 ? 3 - i : i - 4];
  return i < 4 ? vec2(-right.x, right.y) : right;
}
