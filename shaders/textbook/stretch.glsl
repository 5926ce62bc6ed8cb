// Anisotropy as the lecture prints it: an isotropic surface of alpha = alpha.y, stretched along x. Directions take the factor
// alpha.x / alpha.y, normals its inverse.

// a = 1 / (alpha tan theta).
float smith_a(vec3 w, vec2 alpha) {
  vec3 v = normalize(vec3(w.x * alpha.x / alpha.y, w.yz));
  return 1.0 / (alpha.y * sqrt(1.0 - v.z * v.z) / v.z);
}

// The cosine of the stretched normal, and the Jacobian of stretching.
float stretched(vec3 wm, vec2 alpha, out float jacobian) {
  float s = alpha.y / alpha.x;
  vec3 v = vec3(s * wm.x, wm.yz);
  float l = length(v);
  jacobian = s / (l * l * l * l);
  return v.z / l;
}
