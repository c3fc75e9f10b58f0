/// What turns a chunk's mesh into its next one: an edit changes a few walls, and most of a full
/// record would be bytes that the viewer has. protocol/README.md, "Delta record".
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "protocol/chunk_record.hpp"
#include "protocol/result.hpp"

namespace earthwork::protocol {

/// Of a chunk whose mesh of `base_revision` the viewer holds. Comes inside groups only.
struct ChunkDelta {
  ChunkKey key;
  std::uint64_t revision = 0;       ///< Of the mesh that comes out.
  std::uint64_t base_revision = 0;  ///< Of the mesh that it changes; below `revision`.
  std::string operations;           ///< What apply_delta reads, not looked at before.
  friend bool operator==(const ChunkDelta&, const ChunkDelta&) = default;
};

/// Appends a delta record, its u32 length first, that turns `base` into `next`: encoded full
/// records of one chunk, of ascending revisions. False, and nothing appended, when the delta would
/// not be smaller than `next`, or either is no such record, or a mesh's vertices do not ascend by y
/// and then x, as the mesher's do.
bool encode_delta(std::string_view base, std::string_view next, std::string& out);

/// The same for who has the records themselves: full ones, and nothing is appended when it would
/// not be smaller than `next_bytes`.
bool encode_delta(const ChunkRecord& base, const ChunkRecord& next, std::size_t next_bytes,
                  std::string& out);

/// Whether `bytes`, a whole record with its length field, say that they are a delta.
[[nodiscard]] bool is_delta(std::span<const std::byte> bytes);

/// Decodes the head of one delta record that fills `bytes` (length field included). bad_frame says
/// which field is wrong.
[[nodiscard]] Result<ChunkDelta> decode_delta(std::span<const std::byte> bytes);

/// The mesh after `delta`, exactly as encode_delta was given it. `base` is the mesh of delta.key at
/// delta.base_revision; that it is has been checked. Takes time and memory with the base and the
/// delta; bad_frame says which part is wrong.
[[nodiscard]] Result<ChunkRecord> apply_delta(const ChunkMesh& base, const ChunkDelta& delta);

}  // namespace earthwork::protocol
