#include "server/mesh/chunk_cells.hpp"

namespace earthwork::mesh {
namespace {

std::uint64_t row_of(const voxel::Chunk* chunk, int y) { return chunk ? chunk->row(y) : 0; }

std::uint64_t first_bit(const voxel::Chunk* chunk, int y) { return row_of(chunk, y) & 1; }

void append(std::vector<voxel::Crossing>& to, std::span<const voxel::Crossing> from) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

void ChunkCells::assign(const voxel::Neighbourhood& chunks, int resolution) {
  width_ = resolution - (chunks.has_right ? 0 : 1);
  height_ = resolution - (chunks.has_upper ? 0 : 1);
  cells_ = ~std::uint64_t{0} >> (64 - width_);
  read_rows(chunks, resolution);
  if (!uniform()) read_crossings(chunks, resolution);
}

void ChunkCells::read_rows(const voxel::Neighbourhood& chunks, int resolution) {
  for (int y = 0; y <= height_; ++y) {
    const bool own = y < resolution;
    const std::uint64_t row = own ? row_of(chunks.own, y) : row_of(chunks.upper, 0);
    const std::uint64_t next = own ? first_bit(chunks.right, y) : first_bit(chunks.upper_right, 0);
    rows_[static_cast<std::size_t>(y)] = {row, row >> 1 | next << (resolution - 1)};
  }
  any_mixed_ = 0;
  for (int y = 0; y < height_; ++y) {
    const Row &below = rows_[static_cast<std::size_t>(y)],
              &above = rows_[static_cast<std::size_t>(y) + 1];
    const std::uint64_t some = below.low | below.high | above.low | above.high;
    mixed_[static_cast<std::size_t>(y)] = some & cells_ & ~full(y);
    any_mixed_ |= mixed_[static_cast<std::size_t>(y)];
  }
}

// At the border a row's edges beyond the last voxel have no crossing stored, so that what is stored
// is what the cells want.
void ChunkCells::read_crossings(const voxel::Neighbourhood& chunks, int resolution) {
  x_.clear(), y_.clear();
  for (int y = 0; y <= height_; ++y) {
    x_start_[static_cast<std::size_t>(y)] = static_cast<int>(x_.size());
    const voxel::Chunk* chunk = y < resolution ? chunks.own : chunks.upper;
    if (chunk) append(x_, chunk->crossings(voxel::Axis::x, y < resolution ? y : 0));
  }
  for (int y = 0; y < height_; ++y) {
    y_start_[static_cast<std::size_t>(y)] = static_cast<int>(y_.size());
    if (chunks.own) append(y_, chunks.own->crossings(voxel::Axis::y, y));
    if (chunks.right && (chunks.right->mask(voxel::Axis::y, y) & 1) != 0) {
      append(y_, chunks.right->crossings(voxel::Axis::y, y).first(1));
    }
  }
  x_start_[static_cast<std::size_t>(height_) + 1] = static_cast<int>(x_.size());
  y_start_[static_cast<std::size_t>(height_)] = static_cast<int>(y_.size());
}

CellHits ChunkCells::hits(const MixedCell& cell) const {
  const voxel::Crossing *bottom = x_row(cell.y), *top = x_row(cell.y + 1), *sides = y_row(cell.y);
  const unsigned c = cell.cell_case;
  const bool a = (c & 1) != 0, b = (c & 2) != 0, cc = (c & 4) != 0, d = (c & 8) != 0;
  CellHits hits{};
  if (a != b) hits[kBottom] = bottom[cell.index[kBottom]];
  if (b != d) hits[kRight] = sides[cell.index[kRight]];
  if (cc != d) hits[kTop] = top[cell.index[kTop]];
  if (a != cc) hits[kLeft] = sides[cell.index[kLeft]];
  return hits;
}

}  // namespace earthwork::mesh
