/// A field as a map of voxels, without stencils.
#pragma once

#include "server/voxel/map.hpp"
#include "tests/bench/field.hpp"

namespace earthwork::bench {

inline constexpr int kBenchResolution = 64;

/// Voxels along the map's sides: those of the field's that fill whole chunks.
struct MapSize {
  int chunks_x = 0, chunks_y = 0;
  std::uint64_t voxels() const;
  /// The squares between four voxels.
  std::uint64_t cells() const;
};
MapSize size_of(const Field& field);

/// A bounded map of one layer, chunk (0, 0) at its lower left, resolution kBenchResolution; voxel
/// (i, j) is filled where sample (i, j) is negative. Crossings lie where the samples interpolated
/// linearly are 0, with the direction of the central differences' gradient interpolated likewise.
/// The field has at least one whole chunk, and one plane.
voxel::Map make_map(const Field& field);

}  // namespace earthwork::bench
