/// A chunk as few bytes as its crossings allow, to be kept.
///
/// Byte 0 is 16 * kind + log2(resolution / 8), kind being 1: blank, 2: all voxels filled and no
/// crossings, 3: anything else. Of kinds 1 and 2 that is all. Of kind 3, with R = resolution,
/// follow
///   R rows of R/8 bytes      bit i % 8 of byte i / 8 of row j: voxel (i, j) is filled
///   R/8 bytes                bit j: the edge from voxel (R-1, j) toward +x has a crossing
///   R/8 bytes                bit i: the edge from voxel (i, R-1) toward +y has a crossing
///   6 bytes a crossing       u16 offset, i16 nx, i16 ny, little-endian; the x crossings row by
///   row,
///                            left to right, then the y crossings likewise
/// Every other edge has a crossing just where its ends, both of them here, differ. So a chunk of
/// 8 x 8 with voxel (0, 0) filled alone and its two crossings takes 1 + 8 + 1 + 1 + 12 bytes:
/// 30, 01 00 00 00 00 00 00 00, 00, 00, then both crossings.
///
/// A chunk has one form, and only that is read. The longest has 49,681 bytes: R = 64, a crossing on
/// every edge.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "server/voxel/chunk.hpp"

namespace earthwork::voxel {

inline constexpr std::size_t kMaxChunkBytes = 1 + (64 + 2) * 8 + 2 * 64 * 64 * 6;

/// Appends them.
void encode_chunk(const Chunk& chunk, std::string& out);

/// Nothing unless the bytes are those of a chunk: the sizes exact, offsets 1 .. kEdgeSteps - 1,
/// normals' components not beyond kNormalUnit either way. Reads bytes of anybody.
[[nodiscard]] std::optional<Chunk> decode_chunk(std::span<const std::byte> bytes);

}  // namespace earthwork::voxel
