// Slot gauss: the 16 nodes in [-1, 1] and weights of Gauss and Legendre's quadrature.
const vec2 GAUSS[8] = vec2[8](
    vec2(0.09501250984, 0.1894506105), vec2(0.2816035508, 0.182603415), vec2(0.4580167777, 0.1691565194),
    vec2(0.6178762444, 0.1495959888), vec2(0.7554044084, 0.1246289713), vec2(0.8656312024, 0.09515851168),
    vec2(0.9445750231, 0.06225352394), vec2(0.989400935, 0.02715245941));

const int NODES = 16;

// Node and weight, i in [0, 16).
vec2 gauss(int i) {
  vec2 right = GAUSS[i < 8 ? 7 - i : i - 8];
  return i < 8 ? vec2(-right.x, right.y) : right;
}
