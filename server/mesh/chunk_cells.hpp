/// A chunk's cells with all they need from the three upper neighbours, laid out to be walked row by
/// row: which cells are mixed, and every crossing of every row in one run.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "server/mesh/cell.hpp"
#include "server/voxel/map.hpp"

namespace earthwork::mesh {

/// A cell with filled and empty corners. The indices count crossings within their row; one that
/// belongs to a side without a crossing means nothing.
struct MixedCell {
  int x, y;                  ///< Of the cell in the chunk.
  unsigned cell_case;        ///< 1 .. 14
  std::array<int, 4> index;  ///< Bottom: in x row y; right, left: in y row y; top: in x row y + 1.
};

/// Reusable. Row y of the x crossings lies on voxel row y, 0 .. height(); row y of the y crossings
/// between voxel rows y and y + 1, in voxel columns 0 .. width().
class ChunkCells {
 public:
  /// Reads the voxels; nothing is kept of them afterwards.
  void assign(const voxel::Neighbourhood& chunks, int resolution);

  /// Cells in a row and in a column: the resolution, or one less at the map's border.
  int width() const { return width_; }
  int height() const { return height_; }
  /// All voxels that the cells reach are alike.
  bool uniform() const { return any_mixed_ == 0; }
  /// Whether voxel (x, y) is filled, 0 <= x <= width(), 0 <= y <= height().
  bool filled(int x, int y) const {
    const Row& row = rows_[static_cast<std::size_t>(y)];
    return ((x < width_ ? row.low >> x : row.high >> (x - 1)) & 1) != 0;
  }
  /// Cells of row y that have filled and empty corners, a bit each.
  std::uint64_t mixed(int y) const { return mixed_[static_cast<std::size_t>(y)]; }
  /// Cells of row y that are filled at all corners.
  std::uint64_t full(int y) const {
    const Row &below = rows_[static_cast<std::size_t>(y)],
              &above = rows_[static_cast<std::size_t>(y) + 1];
    return below.low & below.high & above.low & above.high & cells_;
  }
  /// Edges along voxel row y that have a crossing, by their left voxel, 0 .. width() - 1.
  std::uint64_t x_mask(int y) const {
    const Row& row = rows_[static_cast<std::size_t>(y)];
    return (row.low ^ row.high) & cells_;
  }
  /// Edges from voxel row y upward in columns 0 .. width() - 1; the last column's is `last_column`.
  std::uint64_t y_mask(int y) const {
    return (rows_[static_cast<std::size_t>(y)].low ^ rows_[static_cast<std::size_t>(y) + 1].low) &
           cells_;
  }
  bool last_column(int y) const { return filled(width_, y) != filled(width_, y + 1); }

  const voxel::Crossing* x_row(int y) const {
    return x_.data() + x_start_[static_cast<std::size_t>(y)];
  }
  const voxel::Crossing* y_row(int y) const {
    return y_.data() + y_start_[static_cast<std::size_t>(y)];
  }
  int x_start(int y) const { return x_start_[static_cast<std::size_t>(y)]; }
  int y_start(int y) const { return y_start_[static_cast<std::size_t>(y)]; }
  int x_count() const { return x_start_[static_cast<std::size_t>(height_) + 1]; }
  int y_count() const { return y_start_[static_cast<std::size_t>(height_)]; }

  /// Calls visit(const MixedCell&) for the mixed cells of row y, left to right.
  template <class Visit>
  void walk_row(int y, Visit&& visit) const;
  /// The crossings on the cell's sides; on a side without one, any.
  CellHits hits(const MixedCell& cell) const;

 private:
  /// A voxel row as seen by its cells: bit x of `low` is the left voxel of cell x, of `high` the
  /// right one.
  struct Row {
    std::uint64_t low = 0, high = 0;
  };
  void read_rows(const voxel::Neighbourhood& chunks, int resolution);
  void read_crossings(const voxel::Neighbourhood& chunks, int resolution);
  void read_y_crossings(const voxel::Neighbourhood& chunks);

  static constexpr std::size_t kRows = voxel::kMaxResolution + 1;
  int width_ = 0, height_ = 0;
  std::uint64_t cells_ = 0;  // a bit for each cell of a row
  std::uint64_t any_mixed_ = 0;
  std::array<Row, kRows> rows_{};
  std::array<std::uint64_t, kRows> mixed_{};
  std::array<int, kRows + 1> x_start_{}, y_start_{};
  std::vector<voxel::Crossing> x_, y_;
};

// A crossing on a row borders a mixed cell on either side, so counting along the mixed cells counts
// the crossings.
template <class Visit>
void ChunkCells::walk_row(int y, Visit&& visit) const {
  const Row &below = rows_[static_cast<std::size_t>(y)],
            &above = rows_[static_cast<std::size_t>(y) + 1];
  int bottom = 0, top = 0, left = 0;
  for (std::uint64_t cells = mixed(y); cells != 0; cells &= cells - 1) {
    const int x = std::countr_zero(cells);
    const auto a = static_cast<unsigned>(below.low >> x & 1),
               b = static_cast<unsigned>(below.high >> x & 1);
    const auto c = static_cast<unsigned>(above.low >> x & 1),
               d = static_cast<unsigned>(above.high >> x & 1);
    const int right = left + static_cast<int>(a ^ c);
    visit(MixedCell{x, y, a | b << 1 | c << 2 | d << 3, {bottom, right, top, left}});
    bottom += static_cast<int>(a ^ b);
    top += static_cast<int>(c ^ d);
    left = right;
  }
}

}  // namespace earthwork::mesh
