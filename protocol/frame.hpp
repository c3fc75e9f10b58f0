/// Binary messages: a group's begin and end, and chunk records in between or on their own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "protocol/chunk_record.hpp"
#include "protocol/record_delta.hpp"
#include "protocol/result.hpp"

namespace earthwork::protocol {

/// From here to the end, all records are one picture: the map as of `seq`.
struct GroupBegin {
  std::uint64_t epoch = 0;
  std::uint64_t seq = 0;
  std::uint32_t view = 0;
  friend bool operator==(const GroupBegin&, const GroupBegin&) = default;
};
struct GroupEnd {
  std::uint64_t seq = 0;
  friend bool operator==(const GroupEnd&, const GroupEnd&) = default;
};

[[nodiscard]] std::string encode(const GroupBegin& begin);
[[nodiscard]] std::string encode(const GroupEnd& end);
/// What a message of records begins with; the next piece of the record stream follows.
[[nodiscard]] std::string_view records_head();

/// A ChunkDelta only between GroupBegin and GroupEnd.
using FrameEvent = std::variant<GroupBegin, ChunkRecord, ChunkDelta, GroupEnd>;

/// Takes a connection's binary messages in order and gives back what they hold. After a failure
/// it must not be fed again.
class FrameReader {
 public:
  /// Appends to `out` all that is complete. Holds at most kMaxRecordBytes.
  [[nodiscard]] Result<void> feed(std::span<const std::byte> message, std::vector<FrameEvent>& out);
  /// Between begin and end.
  [[nodiscard]] bool in_group() const { return in_group_; }

 private:
  [[nodiscard]] Result<void> begin(std::span<const std::byte> body, std::vector<FrameEvent>& out);
  [[nodiscard]] Result<void> end(std::span<const std::byte> body, std::vector<FrameEvent>& out);
  [[nodiscard]] Result<void> records(std::span<const std::byte> body, std::vector<FrameEvent>& out);
  [[nodiscard]] Result<FrameEvent> record(std::span<const std::byte> bytes) const;

  std::vector<std::byte> partial_;  // the start of a record whose end has not come
  bool in_group_ = false;
  std::uint64_t group_seq_ = 0;  // of the group that is open
};

}  // namespace earthwork::protocol
