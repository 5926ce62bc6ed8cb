// Slot tonemap: ACES, the fit of the Reference Rendering Transform and the sRGB Output Device Transform by Stephen Hill
// (Baking Lab, ACES.hlsl). Leaves out the transforms' dependence on luminance levels beyond the fit: it desaturates less.
vec3 tonemap(vec3 color) {
  vec3 v = vec3(dot(vec3(0.59719, 0.35458, 0.04823), color), dot(vec3(0.07600, 0.90834, 0.01566), color),
                dot(vec3(0.02840, 0.13383, 0.83777), color));
  v = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
  return vec3(dot(vec3(1.60475, -0.53108, -0.07367), v), dot(vec3(-0.10208, 1.10813, -0.00605), v),
              dot(vec3(-0.00327, -0.07276, 1.07602), v));
}
