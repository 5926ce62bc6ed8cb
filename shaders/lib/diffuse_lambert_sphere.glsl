// Slot diffuse: the body is a half space of Lambertian spheres, sparse, with exponential free paths. d'Eon 2021, "An Analytic
// BRDF for Materials with Spherical Lambertian Scatterers": one scattering exactly, further ones by the modes 0, 1, 2 of the
// phase function's first three Legendre terms. The albedo is the one that his Eq. 46 maps to c, nearly the body's in even light.
// The tables err by 3.9e-5 of f at most against the exact form (20000 pairs, cosines down to 1e-4). What its three
// terms leave out is lost in the noise, 1e-3 to 2e-3 of f, of walks among spheres. White spheres of them would reflect 1 within
// 1.2e-4, since only the first scattering is exact: `excess` takes that out, times c (1 - s), and 1e-5 is left.
// Eq. 27 is a Fourier coefficient and counts twice: read without the 2 it errs by up to 20 % of f.
#include "lib/lambert_sphere.glsl"
#include "lib/spheres.glsl"

vec3 diffuse_f(vec3 wo, vec3 wi, vec3 albedo, float sigma, float r) {
  vec3 c = sphere_c(albedo), s = sphere_s(albedo);
  float o = wo.z, i = wi.z;
  vec3 h_o = H0_slope(o, s), h_i = H0_slope(i, s);
  vec3 H_o = 1.0 + c * o * h_o, H_i = 1.0 + c * i * h_i;
  // Each mode's sum of w_l (psi_l(o) psi_l(i) - P_l(o) P_l(i)) / c, w = 1, 4/3, 5/16 times (l - m)! / (l + m)!, where
  // psi_l = q_l H = P_l + d_l: the difference is d_o (P_i + d_i) + P_o d_i, in which nothing cancels.
  vec3 sum = vec3(0.0);
  for (int l = 0; l < 3; l++) {
    float P_o = l == 0 ? 1.0 : l == 1 ? o : 1.5 * o * o - 0.5;
    float P_i = l == 0 ? 1.0 : l == 1 ? i : 1.5 * i * i - 0.5;
    vec3 q1 = series(186 + 20 * l, 10, 1, 1.0, s), q2 = series(196 + 20 * l, 10, 1, 1.0, s);
    vec3 d_o = c * o * ((q1 + q2 * o) * H_o + P_o * h_o), d_i = c * i * ((q1 + q2 * i) * H_i + P_i * h_i);
    sum += (l == 0 ? 1.0 : l == 1 ? 4.0 / 3.0 : 5.0 / 16.0) * (d_o * (P_i + d_i) + P_o * d_i);
  }
  float turn = dot(wo.xy, wi.xy);  // sin sin cos(phi)
  h_o = H1_slope(o, s);
  h_i = H1_slope(i, s);
  H_o = 1.0 + c * o * h_o;
  H_i = 1.0 + c * i * h_i;
  vec3 q = series(246, 6, 1, 1.0, s);
  vec3 d_o = c * o * (q * H_o + h_o), d_i = c * i * (q * H_i + h_i);
  vec3 first = 2.0 / 3.0 * (d_o * (1.0 + d_i) + d_i);
  q = series(252, 6, 1, 1.0, s);
  d_o = c * o * (q * H_o + 3.0 * o * h_o);
  d_i = c * i * (q * H_i + 3.0 * i * h_i);
  first += 5.0 / 96.0 * (d_o * (3.0 * i + d_i) + 3.0 * o * d_i);
  d_o = c * o * H2_slope(o, s);
  d_i = c * i * H2_slope(i, s);
  vec3 second = 15.0 / 128.0 * (d_o * (1.0 + d_i) + d_i);
  sum += 2.0 * turn * first + 2.0 * (2.0 * turn * turn - dot(wo.xy, wo.xy) * dot(wi.xy, wi.xy)) * second;
  return c * ((phase(wo, wi) + sum / (4.0 * PI)) / (o + i) - INV_PI * (1.0 - s) * (excess(o) + excess(i)));
}
