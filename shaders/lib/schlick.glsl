// Schlick's approximation of Fresnel reflectance, from that along the normal, and the one that is right at 82 degrees, too.

// Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering", Eq. 15.
float F_schlick(float c, float F0) {
  float m = 1.0 - c;
  float m2 = m * m;
  return F0 + (1.0 - F0) * (m2 * m2 * m);
}

// Schlick's curve bent to be F82 at a cosine of 1/7, 82 degrees, but no brighter than it was: the "F82-tint" model of Kutz, Hasan
// and Edmondson 2021, "Novel aspects of the Adobe Standard Material", after Lazanyi and Szirmay-Kalos 2005 and Hoffman 2019; as
// OpenPBR Surface 1.1 prints it, section "Metal", Eq. 30. The curve is negative for indices next to 1; there it is 0.
float F_f82(float c, float F0, float F82) {
  float m = 1.0 - c;
  float m2 = m * m;
  float edge = F_schlick(1.0 / 7.0, F0);
  float bent = F_schlick(c, F0) - max(edge - F82, 0.0) * (117649.0 * 7.0 / 46656.0) * (c * (m2 * m2 * m2));
  return bent < 0.0 ? 0.0 : bent;
}
