/// Small maps for the micro-benchmarks, the same on every run.
#pragma once

#include "protocol/chunk_record.hpp"
#include "server/voxel/map.hpp"

namespace earthwork::bench {

enum class Ground { empty, full, ring, noise };

/// A map of 2 x 2 chunks of 64 x 64 voxels, alike in all four: nothing, everything, a ring of outer
/// radius 28 and inner radius 18 in each chunk, or many small circles.
voxel::Map make_ground(Ground ground);

/// The mesh of chunk (0, 0) as it would be sent.
protocol::ChunkRecord make_record(Ground ground);

}  // namespace earthwork::bench
