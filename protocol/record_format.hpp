/// Constants of the chunk record's bytes that its two sides share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "protocol/chunk_record.hpp"
#include "protocol/result.hpp"

namespace earthwork::protocol {

inline constexpr std::uint8_t kRecordFull = 1, kRecordRemoved = 2;  ///< First byte of the body.
inline constexpr std::size_t kRecordLengthBytes = 4;
/// u8 kind, u8 layer, i32 x, y, z, u64 revision.
inline constexpr std::size_t kRecordHeadBytes = 22;

/// Lowest bits of a section's varint, below the zigzag step from its start to its end vertex.
inline constexpr int kSectionFlagBits = 2;
inline constexpr std::uint32_t kStartNormalFollows = 1;  ///< Else it is the last section's end's.
inline constexpr std::uint32_t kEndNormalFollows = 2;    ///< Else it is the start's.

/// Of a binary message's field: what is wrong with it.
inline Failure frame_failure(const char* field, const std::string& sentence) {
  return {Code::bad_frame, std::string(field) + ": " + sentence, field};
}
/// Whether the key is within its limits; its layer was a byte. bad_frame names the field.
[[nodiscard]] Result<void> check_key(const ChunkKey& key);

}  // namespace earthwork::protocol
