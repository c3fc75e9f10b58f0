/// Points in space and 4 x 4 matrices, for cameras. Map space: x right, y up, z height toward the
/// viewer.
#pragma once

#include <array>

namespace earthwork::scene {

struct Vec3 {
  double x = 0, y = 0, z = 0;
  friend bool operator==(const Vec3&, const Vec3&) = default;
};

/// Column-major, as OpenGL takes it: element (row, column) stands at 4 * column + row.
struct Mat4 {
  std::array<double, 16> m{};
};

[[nodiscard]] Mat4 operator*(const Mat4& a, const Mat4& b);
/// Of the point (p, 1): x, y, z, w.
[[nodiscard]] std::array<double, 4> operator*(const Mat4& a, const Vec3& p);

}  // namespace earthwork::scene
