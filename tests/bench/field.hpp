/// Field files: the scalar grids that benchmarks read.
///
/// A file is "EWF1", then nx, ny, nz as little-endian u32, then nx * ny * nz float32, x fastest.
/// Negative is inside, the outline lies at 0. A plane of 2 x 1 samples, left inside, right outside:
///
///     45 57 46 31  02 00 00 00  01 00 00 00  01 00 00 00  00 00 80 bf  00 00 80 3f
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace earthwork::bench {

inline constexpr std::uint32_t kMaxFieldSide = 65536;
inline constexpr std::uint64_t kMaxFieldValues = std::uint64_t{1} << 30;

struct Field {
  std::uint32_t nx = 0, ny = 0, nz = 0;  ///< 1 .. kMaxFieldSide, kMaxFieldValues in all.
  std::vector<float> values;             ///< All finite.
  std::string name;                      ///< The file's, without folder and extension.

  /// A plane's sample; beyond the field the nearest one.
  float at(std::int64_t x, std::int64_t y) const;
};

/// Throws std::runtime_error that names the file and what is wrong with it.
Field read_field(const std::string& path);

}  // namespace earthwork::bench
