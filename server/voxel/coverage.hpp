/// What a stencil covers, as a run of voxels a row, and where its outline cuts an edge.
#pragma once

#include <cstdint>
#include <vector>

#include "server/voxel/chunk.hpp"
#include "server/voxel/crossing.hpp"
#include "server/voxel/stencil.hpp"

namespace earthwork::voxel {

/// Voxel columns first .. last, both covered; nothing when first > last.
struct Run {
  std::int32_t first = 0, last = -1;
};

/// Which end of an edge is covered; the lower end is the voxel that the edge belongs to.
enum class End : std::uint8_t { lower, upper };

class Coverage {
 public:
  /// Works out the runs of `stencil`. Memory is reused from one call to the next.
  void assign(const Stencil& stencil, double voxel_size);

  Fill fill() const { return stencil_.fill; }
  /// Nothing is covered.
  bool empty() const { return runs_.empty(); }
  /// The covered voxels' bounding box, in voxels of the map. Not for an empty coverage.
  std::int32_t left() const { return left_; }
  std::int32_t right() const { return right_; }
  std::int32_t bottom() const { return bottom_; }
  std::int32_t top() const { return bottom_ + static_cast<std::int32_t>(runs_.size()) - 1; }
  /// The covered voxels of row `j`; rows beyond the box have none.
  Run run(std::int32_t j) const {
    return j < bottom() || j > top() ? Run{} : runs_[static_cast<std::size_t>(j - bottom_)];
  }

  /// The crossing that the outline makes on the edge leaving voxel (i, j) along `axis`, of which
  /// only the end `covered` is covered. GEOMETRY: "Stencils", rule 2.
  Crossing cut(Axis axis, std::int32_t i, std::int32_t j, End covered) const;

 private:
  double position(std::int32_t index) const { return (index + 0.5) * voxel_size_; }
  bool covers(double along, double across) const;
  Run row_run(std::int32_t j) const;

  Stencil stencil_;
  double voxel_size_ = 1;
  std::int32_t left_ = 0, right_ = -1, bottom_ = 0;
  std::vector<Run> runs_;
};

}  // namespace earthwork::voxel
