/// Meshes and records small enough to be read in hex, and one that is not.
#pragma once

#include "protocol/chunk_record.hpp"

namespace earthwork::protocol {

/// A filled square of one voxel's side with walls all around: 4 vertices, 2 triangles, 4 sections
/// in one chain, each flat.
ChunkMesh square_mesh();
/// The same square with its vertices by y and then x, and with its upper right corner cut off.
ChunkMesh ordered_square_mesh();
ChunkMesh cut_square_mesh();
/// A contour through a chunk with one smooth bend and one crease, beside a second chain.
ChunkMesh bend_mesh();
/// A band of `columns` quads: beyond 127 of them its indices take two bytes.
ChunkMesh band_mesh(int columns);

ChunkRecord record_of(ChunkMesh mesh);
ChunkRecord removed_record();

std::string encoded(const ChunkRecord& record);
std::span<const std::byte> bytes_of(std::string_view text);

}  // namespace earthwork::protocol
