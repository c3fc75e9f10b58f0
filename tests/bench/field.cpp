#include "tests/bench/field.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace earthwork::bench {
namespace {

static_assert(std::endian::native == std::endian::little, "field files are read as they lie");

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw std::runtime_error(path + ": " + why);
}

bool within(std::uint32_t side) { return side >= 1 && side <= kMaxFieldSide; }

void read_into(std::ifstream& file, void* to, std::size_t bytes) {
  file.read(static_cast<char*>(to), static_cast<std::streamsize>(bytes));
}

}  // namespace

float Field::at(std::int64_t x, std::int64_t y) const {
  const auto column = std::clamp<std::int64_t>(x, 0, std::int64_t{nx} - 1);
  const auto row = std::clamp<std::int64_t>(y, 0, std::int64_t{ny} - 1);
  return values[static_cast<std::size_t>(row * std::int64_t{nx} + column)];
}

Field read_field(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse(path, "cannot be opened");
  std::array<char, 4> magic{};
  std::array<std::uint32_t, 3> sides{};
  read_into(file, magic.data(), sizeof magic);
  read_into(file, sides.data(), sizeof sides);
  if (!file || magic != std::array<char, 4>{'E', 'W', 'F', '1'}) refuse(path, "not a field file");

  Field field;
  field.nx = sides[0], field.ny = sides[1], field.nz = sides[2];
  const std::uint64_t plane = std::uint64_t{field.nx} * field.ny;
  if (!within(field.nx) || !within(field.ny) || !within(field.nz) ||
      plane > kMaxFieldValues / field.nz) {
    refuse(path, "sides are 1 .. 65536, and 2^30 values in all");
  }
  const std::size_t count = plane * field.nz;
  if (std::filesystem::file_size(path) != 16 + count * sizeof(float)) {
    refuse(path, "its length does not follow from its sides");
  }
  field.values.resize(count);
  read_into(file, field.values.data(), count * sizeof(float));
  if (!file) refuse(path, "cannot be read whole");
  if (!std::all_of(field.values.begin(), field.values.end(),
                   [](float value) { return std::isfinite(value); })) {
    refuse(path, "holds a value that is not finite");
  }
  field.name = std::filesystem::path(path).stem().string();
  return field;
}

}  // namespace earthwork::bench
