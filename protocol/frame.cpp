// Binary messages: protocol/README.md, "Frames", is the specification.
#include "protocol/frame.hpp"

#include <algorithm>
#include <utility>

#include "protocol/byte_reader.hpp"
#include "protocol/byte_writer.hpp"
#include "protocol/limits.hpp"
#include "protocol/record_format.hpp"

namespace earthwork::protocol {
namespace {

enum Kind : std::uint8_t { kGroupBegin = 1, kRecords = 2, kGroupEnd = 3 };

constexpr std::size_t kHeadBytes = 2, kBeginBytes = 8 + 8 + 4, kEndBytes = 8;

tl::unexpected<Failure> refuse(const char* field, const std::string& sentence) {
  return fail(Code::bad_frame, std::string(field) + ": " + sentence, field);
}

/// The bytes of the record at the front of `stream`, length field included; 0 while its length
/// has not come.
Result<std::size_t> record_bytes(std::span<const std::byte> stream) {
  if (stream.size() < kRecordLengthBytes) return std::size_t{0};
  const std::size_t length = ByteReader(stream).u32();
  if (length < kRecordHeadBytes || length > kMaxRecordBytes)
    return refuse("length", std::to_string(length) + " bytes of a record are outside " +
                                std::to_string(kRecordHeadBytes) + " .. " +
                                std::to_string(kMaxRecordBytes));
  return kRecordLengthBytes + length;
}

}  // namespace

std::string encode(const GroupBegin& begin) {
  std::string message(kHeadBytes + kBeginBytes, '\0');
  ByteWriter out(message.data());
  out.u8(kFrameVersion);
  out.u8(kGroupBegin);
  out.u64(begin.epoch);
  out.u64(begin.seq);
  out.u32(begin.view);
  return message;
}

std::string encode(const GroupEnd& end) {
  std::string message(kHeadBytes + kEndBytes, '\0');
  ByteWriter out(message.data());
  out.u8(kFrameVersion);
  out.u8(kGroupEnd);
  out.u64(end.seq);
  return message;
}

std::string_view records_head() {
  static constexpr char kHead[kHeadBytes] = {static_cast<char>(kFrameVersion), kRecords};
  return {kHead, kHeadBytes};
}

Result<void> FrameReader::feed(std::span<const std::byte> message, std::vector<FrameEvent>& out) {
  if (message.size() > kMaxFrameBytes)
    return refuse("message", std::to_string(message.size()) + " bytes are beyond the limit of " +
                                 std::to_string(kMaxFrameBytes));
  ByteReader head(message);
  const std::uint8_t version = head.u8(), kind = head.u8();
  if (head.failed()) return refuse("message", "is shorter than its two bytes of head");
  if (version != kFrameVersion)
    return fail(Code::bad_version,
                "version: " + std::to_string(version) + " is not " + std::to_string(kFrameVersion),
                "version");
  const auto body = message.subspan(kHeadBytes);
  switch (kind) {
    case kGroupBegin:
      return begin(body, out);
    case kRecords:
      return records(body, out);
    case kGroupEnd:
      return end(body, out);
    default:
      return refuse("kind", std::to_string(kind) + " is not 1, 2 or 3");
  }
}

Result<void> FrameReader::begin(std::span<const std::byte> body, std::vector<FrameEvent>& out) {
  if (body.size() != kBeginBytes) return refuse("group begin", "is not 22 bytes long");
  if (!partial_.empty()) return refuse("group begin", "comes inside a record");
  if (in_group_) return refuse("group begin", "comes inside a group");
  ByteReader in(body);
  GroupBegin begin;
  begin.epoch = in.u64();
  begin.seq = in.u64();
  begin.view = in.u32();
  in_group_ = true;
  group_seq_ = begin.seq;
  out.emplace_back(begin);
  return {};
}

Result<void> FrameReader::end(std::span<const std::byte> body, std::vector<FrameEvent>& out) {
  if (body.size() != kEndBytes) return refuse("group end", "is not 10 bytes long");
  if (!partial_.empty()) return refuse("group end", "comes inside a record");
  if (!in_group_) return refuse("group end", "comes outside a group");
  const GroupEnd end{ByteReader(body).u64()};
  if (end.seq != group_seq_) return refuse("group end", "has another seq than its begin");
  in_group_ = false;
  out.emplace_back(end);
  return {};
}

Result<void> FrameReader::records(std::span<const std::byte> body, std::vector<FrameEvent>& out) {
  if (body.empty()) return refuse("records", "are none");
  // Whole records are decoded where they lie; only what waits for its end is copied.
  const bool waiting = !partial_.empty();
  if (waiting) partial_.insert(partial_.end(), body.begin(), body.end());
  const std::span<const std::byte> stream = waiting ? std::span<const std::byte>(partial_) : body;
  std::size_t taken = 0;
  for (;;) {
    const auto rest = stream.subspan(taken);
    const auto size = record_bytes(rest);
    if (!size) return tl::unexpected<Failure>(size.error());
    if (*size == 0 || rest.size() < *size) break;
    auto event = record(rest.first(*size));
    if (!event) return tl::unexpected<Failure>(std::move(event.error()));
    out.push_back(std::move(*event));
    taken += *size;
  }
  if (waiting)
    partial_.erase(partial_.begin(), partial_.begin() + static_cast<std::ptrdiff_t>(taken));
  else
    partial_.assign(body.begin() + static_cast<std::ptrdiff_t>(taken), body.end());
  return {};
}

Result<FrameEvent> FrameReader::record(std::span<const std::byte> bytes) const {
  if (!is_delta(bytes))
    return decode_record(bytes).map(
        [](ChunkRecord&& full) -> FrameEvent { return std::move(full); });
  if (!in_group_) return refuse("kind", "a delta comes outside a group");
  return decode_delta(bytes).map([](ChunkDelta&& delta) -> FrameEvent { return std::move(delta); });
}

}  // namespace earthwork::protocol
