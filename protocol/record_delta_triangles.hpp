/// The triangles' part of a delta: those of the base whose corners are all kept, in order, some
/// skipped and others put in between. protocol/README.md, "Delta record".
#pragma once

#include <cstdint>
#include <span>

#include "protocol/byte_appender.hpp"
#include "protocol/byte_reader.hpp"
#include "protocol/chunk_record.hpp"
#include "protocol/result.hpp"

namespace earthwork::protocol {

/// `of_base` is the number in `next` of each vertex of `base`, or kNoVertex.
void write_triangles(const ChunkMesh& base, const ChunkMesh& next,
                     std::span<const std::uint32_t> of_base, ByteAppender& out);

/// The other way round: `mesh` has its vertices and sections. bad_frame says what is wrong, unless
/// `in` has failed.
[[nodiscard]] Result<void> read_triangles(ByteReader& in, const ChunkMesh& base,
                                          std::span<const std::uint32_t> of_base, ChunkMesh& mesh);

}  // namespace earthwork::protocol
