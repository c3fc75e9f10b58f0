/// The light that maps are drawn in: one lamp from the upper left and a bright sky.
#pragma once

#include <array>

namespace earthwork::viewer::render {

/// What all pictures have in common; sRGB, opacity where there is a fourth.
inline constexpr std::array<float, 3> kOutsideColor = {0.835F, 0.847F, 0.855F};
inline constexpr std::array<float, 3> kInsideColor = {0.925F, 0.929F, 0.925F};
inline constexpr std::array<float, 4> kBorderColor = {0.43F, 0.46F, 0.49F, 1.0F};
inline constexpr float kBorderWidth = 1.5F;  ///< CSS pixels.
inline constexpr std::array<float, 4> kShadowColor = {0.10F, 0.13F, 0.18F, 0.22F};

/// How far a shadow falls, in map units for each unit of height: away from the lamp.
inline constexpr std::array<double, 2> kShadowFall = {0.66, -0.44};

/// GLSL: `vec3 lit(vec3 color, vec3 normal)` of sRGB colours, the normal a unit vector. A surface
/// that faces up keeps its layer's colour. Light is added up as it is in nature; the square root
/// brings it to sRGB, whose values are near enough to those of a gamma of 2.
inline constexpr const char* kLightCode = R"(
vec3 light_on(vec3 normal) {
  const vec3 lamp = vec3(-0.600, 0.400, 0.693);
  vec3 sky = mix(vec3(0.38, 0.37, 0.36), vec3(0.40, 0.43, 0.47), 0.5 + 0.5 * normal.z);
  float facing = dot(normal, lamp);
  return sky + vec3(0.90, 0.86, 0.80) * (max(facing, 0.0) + 0.12 * max(-facing, 0.0));
}
vec3 lit(vec3 color, vec3 normal) {
  return color * sqrt(light_on(normal) / light_on(vec3(0.0, 0.0, 1.0)));
}
)";

}  // namespace earthwork::viewer::render
