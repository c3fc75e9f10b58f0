#include "server/voxel/chunk_bytes.hpp"

#include <bit>
#include <cstring>

namespace earthwork::voxel {
namespace {

static_assert(std::endian::native == std::endian::little, "stored bytes are memory's bytes");
static_assert(sizeof(Crossing) == 6, "a crossing is stored as it lies in memory");

enum Kind : unsigned { kBlank = 1, kFull = 2, kMixed = 3 };
constexpr int kLeastResolution = 8;

/// Row, or any `resolution` bits.
std::size_t line_bytes(int resolution) { return static_cast<std::size_t>(resolution) / 8; }

void append_line(std::uint64_t bits, int resolution, std::string& out) {
  char bytes[sizeof bits];
  std::memcpy(bytes, &bits, sizeof bits);
  out.append(bytes, line_bytes(resolution));
}

std::uint64_t take_line(std::span<const std::byte>& in, int resolution) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, in.data(), line_bytes(resolution));
  in = in.subspan(line_bytes(resolution));
  return bits;
}

/// Bit y: whether the edge that leaves the last voxel of row y toward +x has a crossing.
std::uint64_t last_column(const Chunk& chunk) {
  std::uint64_t bits = 0;
  for (int y = 0; y < chunk.resolution(); ++y)
    bits |= (chunk.mask(Axis::x, y) >> (chunk.resolution() - 1) & 1) << y;
  return bits;
}

/// The masks that follow from the rows, completed by what neighbours know.
void derive_masks(ChunkParts& parts, std::uint64_t column, std::uint64_t row) {
  const int last = parts.resolution - 1;
  const std::uint64_t inner = ~std::uint64_t{0} >> (kMaxResolution - last);
  for (int y = 0; y <= last; ++y) {
    const auto at = static_cast<std::size_t>(y);
    const std::uint64_t states = parts.rows[at];
    parts.x_masks[at] = ((states ^ states >> 1) & inner) | (column >> y & 1) << last;
    parts.y_masks[at] = y < last ? states ^ parts.rows[at + 1] : row;
  }
}

std::size_t count(const Rows& masks) {
  std::size_t bits = 0;
  for (const std::uint64_t mask : masks) bits += static_cast<std::size_t>(std::popcount(mask));
  return bits;
}

bool valid(const Crossing& crossing) {
  return crossing.offset >= 1 && crossing.offset < kEdgeSteps &&
         crossing.normal.x >= -kNormalUnit && crossing.normal.y >= -kNormalUnit;
}

bool take_crossings(std::span<const std::byte>& in, std::vector<Crossing>& out, std::size_t many) {
  out.resize(many);
  if (many > 0) std::memcpy(out.data(), in.data(), many * sizeof(Crossing));
  in = in.subspan(many * sizeof(Crossing));
  for (const Crossing& crossing : out)
    if (!valid(crossing)) return false;
  return true;
}

std::optional<Chunk> decode_mixed(int resolution, std::span<const std::byte> in) {
  if (in.size() < (static_cast<std::size_t>(resolution) + 2) * line_bytes(resolution))
    return std::nullopt;
  ChunkParts parts;
  parts.resolution = resolution;
  for (int y = 0; y < resolution; ++y)
    parts.rows[static_cast<std::size_t>(y)] = take_line(in, resolution);
  const std::uint64_t column = take_line(in, resolution), row = take_line(in, resolution);
  derive_masks(parts, column, row);
  const std::size_t x = count(parts.x_masks), y = count(parts.y_masks);
  if (x + y == 0 || in.size() != (x + y) * sizeof(Crossing)) return std::nullopt;
  if (!take_crossings(in, parts.x, x) || !take_crossings(in, parts.y, y)) return std::nullopt;
  return Chunk::assemble(parts);
}

}  // namespace

void encode_chunk(const Chunk& chunk, std::string& out) {
  const int resolution = chunk.resolution();
  const Kind kind = !chunk.uniform() ? kMixed : chunk.blank() ? kBlank : kFull;
  const int size = std::countr_zero(static_cast<unsigned>(resolution / kLeastResolution));
  out.push_back(static_cast<char>(16 * kind + static_cast<unsigned>(size)));
  if (kind != kMixed) return;
  for (int y = 0; y < resolution; ++y) append_line(chunk.row(y), resolution, out);
  append_line(last_column(chunk), resolution, out);
  append_line(chunk.mask(Axis::y, resolution - 1), resolution, out);
  for (const Axis axis : {Axis::x, Axis::y}) {
    const auto crossings = chunk.crossings(axis);
    out.append(reinterpret_cast<const char*>(crossings.data()), crossings.size_bytes());
  }
}

std::optional<Chunk> decode_chunk(std::span<const std::byte> bytes) {
  if (bytes.empty()) return std::nullopt;
  const auto head = std::to_integer<unsigned>(bytes[0]);
  const unsigned kind = head / 16, size = head % 16;
  if (size > 3) return std::nullopt;
  const int resolution = kLeastResolution << size;
  if (kind == kMixed) return decode_mixed(resolution, bytes.subspan(1));
  if (bytes.size() != 1 || (kind != kBlank && kind != kFull)) return std::nullopt;
  ChunkParts parts;
  parts.resolution = resolution;
  if (kind == kFull) parts.rows[0] = 1;  // of a chunk without crossings, one voxel tells of all
  return Chunk::assemble(parts);
}

}  // namespace earthwork::voxel
