#include "client/scene/vector.hpp"

#include <cstddef>

namespace earthwork::scene {

Mat4 operator*(const Mat4& a, const Mat4& b) {
  Mat4 product;
  for (std::size_t column = 0; column < 4; ++column)
    for (std::size_t row = 0; row < 4; ++row)
      for (std::size_t k = 0; k < 4; ++k)
        product.m[4 * column + row] += a.m[4 * k + row] * b.m[4 * column + k];
  return product;
}

std::array<double, 4> operator*(const Mat4& a, const Vec3& p) {
  std::array<double, 4> image{};
  for (std::size_t row = 0; row < 4; ++row)
    image[row] = a.m[row] * p.x + a.m[4 + row] * p.y + a.m[8 + row] * p.z + a.m[12 + row];
  return image;
}

}  // namespace earthwork::scene
