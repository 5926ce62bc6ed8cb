// The sum c + v of a direction v and a point c of the sphere, drawn evenly from the cap above -(1 - cut) v.z: Dupuy and Benyoub 2023,
// "Sampling Visible GGX Normals with Spherical Caps", Listing 3; Eto and Tokuyoshi 2023, Eq. 5, for a cut of more than 0. Where
// c is opposite to v, which is where facets are seen from the side, both parts of the sum cancel: so it is taken along v's azimuth
// and across it, from the angle between the azimuths of c and v, and its height as a product: 2 -> 5e-6 in a reflected direction.
#include "lib/common.glsl"

vec3 sum_with_cap(vec3 v, vec2 u, float cut) {
  float sin_o = length(v.xy);
  vec2 azimuth = sin_o > 0.0 ? v.xy / sin_o : vec2(1.0, 0.0);
  float phi = TWO_PI * u.x;
  float cosine = azimuth.x * cos(phi) + azimuth.y * sin(phi);
  float sine = azimuth.x * sin(phi) - azimuth.y * cos(phi);
  float low = cut * v.z;  // the least height of the sum
  float wide = 1.0 + abs(v.z);
  float narrow = sin_o * sin_o / wide;  // 1 - |v.z|
  float extent = (v.z < 0.0 ? narrow : wide) - low;
  float height = (1.0 - u.y) * extent + low;
  float q = u.y * extent;  // 1 - c.z
  float t = v.z < 0.0 ? wide : narrow;  // 1 - v.z
  float r = sqrt(q * (t + height));  // sqrt((1 - c.z) (1 + c.z))
  float outer = r + sin_o;
  float excess = outer > 0.0 ? height * (q - t) / outer : 0.0;  // r - sin_o
  float along = cosine < 0.0 ? excess * cosine + sin_o * sine * sine / (1.0 - cosine) : r * cosine + sin_o;
  return vec3(along * azimuth + r * sine * vec2(-azimuth.y, azimuth.x), height);
}
