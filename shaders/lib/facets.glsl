// The lecture's integral over facets that are no mirrors ("Non-Specular Microfacets"), without f_mf's constant and without G:
//   integral of D(wm) (wo . wm)+ (wi . wm)+ exp(kappa (wi . R(wm, wo) - wi . R(h, wo))) d wm,
// a lobe of sharpness kappa about the facet's mirror direction R, with h the half vector, where the exponent is 0, its largest. With
// kappa = 0 the facets are Lambertian. The exponent is -2 kappa (t^2 + c^2 a^2): t and a are wm's components along wo - wi and
// along wo x wi, c is wo . h. So it is the same for wo and wi exchanged, and so are the nodes: the rule is reciprocal.
//
// Facets that both directions see are a triangle on the sphere of normals n, where wm is (alpha_x n.x, alpha_y n.y, n.z) over its
// length: n is above the planes of the stretched wo and wi and of the surface. Two of these, p and q, are farthest apart; where their
// planes meet lies a corner, from which rays of angle omega are followed by psi down to the third plane, k. Inside, all is smooth, so
// nodes by nodes points of Gauss and Legendre suffice. For a sharp lobe the triangle is cut down to the cone in which the lobe
// is above exp(-1 - nodes / 2) of its peak.
//
// The relative error for cosines above 0.1, alpha from 0.01 and a facet's lobe within three of its widths, by nodes; median, largest:
//               8                12               16
//   kappa = 0   2e-5, 1e-3       3e-6, 2e-4       3e-7, 7e-5    GGX
//               8e-3, 2e-2       4e-4, 2e-3       2e-5, 1e-4    Beckmann
//   a lobe      4e-3, 0.3        4e-4, 0.1        5e-5, 0.03    both; largest where kappa alpha^2 is near 0.1
// Of a lobe much sharper than the facets' slopes the cut leaves out exp(-1 - nodes / 2): 7e-3, 9e-4, 1.2e-4.
#include "lib/common.glsl"
#include "lib/transcendental.glsl"

// Whoever includes this has these, of the slots ndf and gauss.
float D(vec3 wm, vec2 alpha);
vec2 gauss(int i);

const float PARALLEL = 1e-15;  // length of a product of two directions below which these are one, and their plane is any
const float UPRIGHT = 1e-12;  // squared length of wo - wi across h below which its direction is rounding
const float LEAST_DENSITY = 1e-30;  // of D, under a logarithm
const float LEAST_SHARPNESS = 1e-3;  // of twice kappa, under a fraction; below the least sharpness of a lobe
const float NARROW = 0.3;  // of P over its value for a sharp lobe: where a wider cone ends rounding says, so nothing is cut

// node_scale: of the slot facets; nodes: the number of those that gauss gives, NODES.
float facets(vec3 wo, vec3 wi, vec2 alpha, float kappa, float node_scale, int nodes) {
  vec3 stretch = vec3(node_scale * alpha, 1.0);
  float size_o = length(stretch * wo), size_i = length(stretch * wi);
  vec3 o = stretch * wo / size_o, i = stretch * wi / size_i, z = vec3(0.0, 0.0, 1.0);
  float off_oi = dot(o - i, o - i), off_o = dot(o - z, o - z), off_i = dot(i - z, i - z);
  bool z_between = off_oi > 1.0001 * max(off_o, off_i);  // no tie where a grazing direction is square to the other
  vec3 p = z_between || off_o > off_i ? o : i;
  vec3 q = z_between ? i : z;
  vec3 k = z_between ? z : off_o > off_i ? i : o;

  // The corner: as a direction of wm it is the product of the two before they are stretched, in which alpha does not cancel
  vec3 both_ways = wo + wi, t = wo - wi;  // wo x wi = t x both_ways / 2, in which nothing cancels
  vec3 u_x = z_between ? cross(t, both_ways) : cross(off_o > off_i ? wo : wi, z);
  float side = dot(z_between ? z : off_o > off_i ? wi : wo, u_x) < 0.0 ? -1.0 : 1.0;
  float size = length(u_x);
  u_x = size > PARALLEL ? u_x * (side / size) : vec3(side, 0.0, 0.0);
  float size_corner = length(u_x / stretch);
  vec3 corner = u_x / stretch / size_corner;
  float k_corner = max(dot(k, corner), 0.0);

  // the lobe about h: t and c a of wm = stretch * n, as linear forms of n - n_h = x corner + y across, projected
  // lengths of wo and wi that differ by a rounding tilt the shorter of these to the other: it is made upright
  bool obtuse = dot(t, t) > dot(both_ways, both_ways);
  if (obtuse) both_ways -= dot(both_ways, t) / dot(t, t) * t;
  float c = 0.5 * length(both_ways);
  vec3 h = both_ways / (2.0 * c);
  float size_n = length(h / stretch);
  vec3 turned = z_between && obtuse ? normalize(t) : side * cross(h, u_x);  // where t is nearly level its z cancels in the product
  t -= dot(t, h) * h;
  if (dot(t, t) < UPRIGHT) {
    t = abs(h.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    t -= dot(t, h) * h;
  }
  t = normalize(t);
  vec3 a = c * cross(h, t);
  vec3 n_h = h / stretch / size_n;
  float rise = dot(n_h, corner);
  float reach = max(length(stretch * turned) / (stretch.x * stretch.y * size_n * size_corner), PARALLEL);
  vec3 across = normalize(stretch * turned), u_y = normalize(stretch * stretch * turned);
  vec3 ray_h = side * cross(corner, across);

  // its cone, for x and y in units of x_unit and y_unit, so that all is of the size of 1 or of rho:
  // P x^2 + 2 Q x y + S y^2 - 2 rho (g_x x + g_y y) - rho <= 0, and where that has a solution x, A y^2 + 2 B y + C >= 0
  float y_size = length(stretch * across);
  float x_unit = size_corner / size_n, y_unit = 1.0 / (size_n * y_size);
  vec2 f_x = vec2(dot(t, u_x), dot(a, u_x)), f_y = vec2(dot(t, u_y), dot(a, u_y));
  float level = 1.0 + 0.5 * float(nodes);
  level += min(2.0 * kappa * (t.z * t.z + a.z * a.z), log_precise(D(z, alpha) / max(D(h, alpha), LEAST_DENSITY)));
  float rho = level / max(2.0 * kappa, LEAST_SHARPNESS);
  float u_xy = dot(u_x, u_y), g_x = dot(u_x, h), g_y = dot(u_y, h);
  float P = dot(f_x, f_x) - rho, Q = dot(f_x, f_y) - rho * u_xy, S = dot(f_y, f_y) - rho;
  bool cone = kappa > 0.0 && P > NARROW * dot(f_x, f_x);
  float det = f_x.x * f_y.y - f_x.y * f_y.x;
  vec3 mixed_t = f_x.x * u_y - f_y.x * u_x, mixed_a = f_x.y * u_y - f_y.y * u_x, normal = cross(u_x, u_y);
  float A = rho * (dot(mixed_t, mixed_t) + dot(mixed_a, mixed_a)) - det * det - rho * rho * dot(normal, normal);
  float B = rho * (P * g_y - Q * g_x);
  float C = rho * (rho * g_x * g_x + P);

  // p . n_h, q . n_h and k . n_h, in which nothing cancels
  float o_h = c / (size_o * size_n), i_h = c / (size_i * size_n), z_h = h.z / size_n;
  float p_h = z_between || off_o > off_i ? o_h : i_h;
  float q_h = z_between ? i_h : z_h;
  float k_h = z_between ? z_h : off_o > off_i ? i_h : o_h;
  float p_across = dot(p, across), q_across = dot(q, across), k_across = dot(k, across);

  // the angle omega of rays, from the ray through n_h on, to the planes of p and q and within the cone
  float low = -atan2_precise(p_h, reach * p_across), high = atan2_precise(q_h, -reach * q_across);
  if (cone && B * B > A * C) {
    float sum = sqrt(B * B - A * C) + abs(B);
    float near = atan2_precise(C * y_unit, sum * reach);
    float far = A < 0.0 ? atan2_precise(sum * y_unit, -A * reach) : PI;
    low = max(low, B > 0.0 ? -near : -far);
    high = min(high, B > 0.0 ? far : near);
  }

  float sum = 0.0;
  for (int j = 0; j < nodes; ++j) {
    vec2 outer = gauss(j);
    float omega = 0.5 * (low + high) + 0.5 * (high - low) * outer.x;
    float bent = sin(omega), straight = cos(omega);
    vec3 ray = straight * ray_h + bent * across;
    float psi_k = atan2_precise(k_corner, -dot(k, ray));
    vec3 flat_h = straight / reach * vec3(p_h, q_h, k_h) + bent * vec3(p_across, q_across, k_across);
    flat_h.xy = max(flat_h.xy, vec2(0.0));  // n_k has another term, and is not below 0 with that
    vec2 foot = vec2(reach, rise * straight);  // where the ray passes n_h, by the projection
    float psi_h = atan2_precise(foot.x, foot.y), size_h = length(foot);
    float first = -psi_h, last = psi_k - psi_h;  // of psi - psi_h
    if (cone && straight > 0.0) {
      float y = reach * bent / (straight * y_unit);
      float b = Q * y - rho * g_x;
      float sum = sqrt(max((A * y + 2.0 * B) * y + C, 0.0)) + abs(b);
      float near = ((S * y - 2.0 * rho * g_y) * y - rho) / sum;  // the roots of x are these, without the sign of b
      float x_low = straight * x_unit * (b > 0.0 ? -sum / P : near);
      float x_high = straight * x_unit * (b > 0.0 ? -near : sum / P);
      first = max(first, atan2_precise(-reach * x_high, size_h * size_h + foot.y * x_high));
      last = min(last, atan2_precise(-reach * x_low, size_h * size_h + foot.y * x_low));
    }
    if (last <= first) continue;
    float part = 0.0;
    for (int l = 0; l < nodes; ++l) {
      vec2 inner = gauss(l);
      float step = 0.5 * (first + last) + 0.5 * (last - first) * inner.x;  // psi - psi_h
      float sine = sin(psi_h + step);
      vec3 n = cos(psi_h + step) * corner + sine * ray;
      float past = sin(step) * size_h / reach;
      float n_p = flat_h.x * sine, n_q = flat_h.y * sine, n_k = max(flat_h.z * sine - past * k_corner, 0.0);
      n.z = z_between ? n_k : n_q;
      float both = z_between ? n_p * n_q : n_p * n_k;  // (o . n) (i . n)
      vec3 m = stretch * n;
      float m2 = dot(m, m);
      vec2 off = sine * bent * y_size * f_y - past / size_corner * f_x;  // t and a of m
      float lobe = exp_precise(-2.0 * kappa * dot(off, off) / m2);
      part += inner.y * D(m, alpha) * lobe * both * sine / (m2 * m2 * sqrt(m2));
    }
    sum += outer.y * part * 0.5 * (last - first);
  }
  return sum * 0.5 * (high - low) * size_o * size_i * stretch.x * stretch.y;
}
