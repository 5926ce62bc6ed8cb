// Reflectance in linear RGB of a metal whose indices are known at 16 wavelengths, 420, 438, ... 690 nm, under D65: CIE 1931, Rec.
// 709's primaries, a perfect mirror is (1, 1, 1). By presets/derive_metals.py. Errs by at most 9e-4 against steps of 1 nm from 360
// to 830 nm: for gold, whose red is up to 1.037, a colour that the primaries cannot show.
#include "lib/fresnel.glsl"

// What R, G and B see of a reflectance that is linear between the wavelengths.
const vec3 RGB[16] = vec3[](
  vec3(0.021231, -0.019160, 0.140215),
  vec3(0.034837, -0.035111, 0.298269),
  vec3(0.012378, -0.024665, 0.351773),
  vec3(-0.041097, 0.020284, 0.225477),
  vec3(-0.091416, 0.081782, 0.082051),
  vec3(-0.145300, 0.171938, 0.013887),
  vec3(-0.144942, 0.252222, -0.018645),
  vec3(-0.049157, 0.258005, -0.028628),
  vec3(0.107490, 0.199579, -0.026579),
  vec3(0.271450, 0.109097, -0.018937),
  vec3(0.365235, 0.027204, -0.010703),
  vec3(0.328681, -0.012055, -0.005126),
  vec3(0.197825, -0.015775, -0.002033),
  vec3(0.089088, -0.008726, -0.000714),
  vec3(0.031509, -0.003304, -0.000225),
  vec3(0.012187, -0.001315, -0.000083)
);

// eta and k hold the wavelengths' indices in their order, four a column.
vec3 F_spectral(float c, mat4 eta, mat4 k) {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 16; i++) sum += RGB[i] * F_conductor(c, eta[i / 4][i % 4], k[i / 4][i % 4]);
  return sum;
}
