#include "server/mesh/chunk_cells.hpp"

namespace earthwork::mesh {
namespace {

std::uint64_t row_of(const voxel::Chunk* chunk, int y) { return chunk ? chunk->row(y) : 0; }

std::uint64_t first_bit(const voxel::Chunk* chunk, int y) { return row_of(chunk, y) & 1; }

void append(std::vector<voxel::Crossing>& to, std::span<const voxel::Crossing> from) {
  if (from.size() <= 4) {
    for (const voxel::Crossing& crossing : from) to.push_back(crossing);
  } else {
    to.insert(to.end(), from.begin(), from.end());
  }
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

// A chunk's own crossings lie in row order already and are copied as a whole. At the border there
// are none on edges beyond the last voxel, so that what is stored is what the cells want.
void ChunkCells::read_crossings(const voxel::Neighbourhood& chunks, int resolution) {
  x_.clear(), y_.clear();
  if (chunks.own) append(x_, chunks.own->crossings(voxel::Axis::x));
  int start = 0;
  for (int y = 0; y <= height_; ++y) {
    x_start_[static_cast<std::size_t>(y)] = start;
    start += y < resolution && chunks.own ? chunks.own->crossing_count(voxel::Axis::x, y) : 0;
  }
  if (height_ == resolution && chunks.upper) {
    append(x_, chunks.upper->crossings(voxel::Axis::x, 0));
    start = static_cast<int>(x_.size());
  }
  x_start_[static_cast<std::size_t>(height_) + 1] = start;
  read_y_crossings(chunks);
  // `hits` reads an index past a row where the side has no crossing.
  x_.push_back({}), y_.push_back({});
}

void ChunkCells::read_y_crossings(const voxel::Neighbourhood& chunks) {
  for (int y = 0; y < height_; ++y) {
    y_start_[static_cast<std::size_t>(y)] = static_cast<int>(y_.size());
    if (chunks.own) append(y_, chunks.own->crossings(voxel::Axis::y, y));
    if (chunks.right && (chunks.right->mask(voxel::Axis::y, y) & 1) != 0) {
      y_.push_back(chunks.right->crossings(voxel::Axis::y, y).front());
    }
  }
  y_start_[static_cast<std::size_t>(height_)] = static_cast<int>(y_.size());
}

CellHits ChunkCells::hits(const MixedCell& cell) const {
  const voxel::Crossing* sides = y_row(cell.y);
  return {{x_row(cell.y)[cell.index[kBottom]], sides[cell.index[kRight]],
           x_row(cell.y + 1)[cell.index[kTop]], sides[cell.index[kLeft]]}};
}

}  // namespace earthwork::mesh
