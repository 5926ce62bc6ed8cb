// Slot tonemap: AgX by Troy Sobotka, its default look, the curve as the polynomial of Benjamin Wrensch ("Minimal AgX
// Implementation", 2023; mean error 3.7e-6 squared). Its result is encoded with gamma 2.2 and is made linear again here.
vec3 tonemap(vec3 color) {
  vec3 v = vec3(dot(vec3(0.842479062253094, 0.0784335999999992, 0.0792237451477643), color),
                dot(vec3(0.0423282422610123, 0.878468636469772, 0.0791661274605434), color),
                dot(vec3(0.0423756549057051, 0.0784336, 0.879142973793104), color));
  vec3 x = (clamp(log2(max(v, 1e-10)), -12.47393, 4.026069) + 12.47393) / (4.026069 + 12.47393);
  // Horner's form: the powers, added one by one, would err by 2e-5 near white
  x = (((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x + 0.1191) * x - 0.00232;
  v = vec3(dot(vec3(1.19687900512017, -0.0980208811401368, -0.0990297440797205), x),
           dot(vec3(-0.0528968517574562, 1.15190312990417, -0.0989611768448433), x),
           dot(vec3(-0.0529716355144438, -0.0980434501171241, 1.15107367264116), x));
  return pow(max(v, 0.0), vec3(2.2));
}
