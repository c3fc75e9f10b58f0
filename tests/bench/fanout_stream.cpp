#include "tests/bench/fanout_stream.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace earthwork::bench {
namespace {

constexpr unsigned kText = 1, kBinary = 2, kPing = 9;
constexpr unsigned kFinal = 0x80, kMasked = 0x80, kOpcodeBits = 0x0f, kLengthBits = 0x7f;
constexpr unsigned kLength16 = 126, kLength64 = 127;
constexpr unsigned char kGroupBegin = 1, kRecords = 2, kGroupEnd = 3;

/// Moves bytes from the front of `from` to `to` until it is full or there are no more.
template <std::size_t Size>
void fill(std::array<unsigned char, Size>& to, std::size_t& filled, std::size_t wanted,
          std::span<const unsigned char>& from) {
  const std::size_t count = std::min(wanted - filled, from.size());
  std::copy_n(from.begin(), count, to.begin() + static_cast<std::ptrdiff_t>(filled));
  filled += count;
  from = from.subspan(count);
}

}  // namespace

std::size_t StreamCounter::header_size() const {
  if (header_filled_ < 2) return 2;
  const unsigned length = header_[1] & kLengthBits;
  return length == kLength16 ? 4 : length == kLength64 ? 10 : 2;
}

void StreamCounter::feed(std::span<const unsigned char> bytes) {
  while (!bytes.empty()) {
    if (!in_body_) {
      fill(header_, header_filled_, header_size(), bytes);
      if (header_filled_ < 2 || header_filled_ < header_size()) continue;
      read_header();
    } else {
      const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(left_, bytes.size()));
      read_body(bytes.first(count));
      left_ -= count;
      bytes = bytes.subspan(count);
    }
    if (in_body_ && left_ == 0) end_message();
  }
}

void StreamCounter::read_header() {
  if (!(header_[0] & kFinal) || (header_[1] & kMasked))
    throw std::runtime_error("a fragment or a masked message");
  opcode_ = header_[0] & kOpcodeBits;
  left_ = header_[1] & kLengthBits;
  if (header_filled_ > 2) {
    left_ = 0;
    for (std::size_t i = 2; i < header_filled_; ++i) left_ = left_ << 8 | header_[i];
  }
  header_filled_ = 0;
  frame_head_filled_ = 0;
  in_body_ = true;
}

void StreamCounter::read_body(std::span<const unsigned char> bytes) {
  if (opcode_ == kText) {
    text_.append(bytes.begin(), bytes.end());
  } else if (opcode_ == kBinary) {
    fill(frame_head_, frame_head_filled_, 2, bytes);
    if (frame_head_filled_ == 2 && frame_head_[1] == kRecords) read_records(bytes);
  }
}

void StreamCounter::read_records(std::span<const unsigned char> bytes) {
  while (!bytes.empty()) {
    if (record_left_ == 0) {
      fill(length_, length_filled_, 4, bytes);
      if (length_filled_ < 4) return;
      length_filled_ = 0;
      record_left_ = length_[0] | static_cast<std::uint64_t>(length_[1]) << 8 |
                     static_cast<std::uint64_t>(length_[2]) << 16 |
                     static_cast<std::uint64_t>(length_[3]) << 24;
      counts_.bytes += 4;
    }
    const auto count =
        static_cast<std::size_t>(std::min<std::uint64_t>(record_left_, bytes.size()));
    record_left_ -= count;
    counts_.bytes += count;
    bytes = bytes.subspan(count);
    if (record_left_ == 0) ++counts_.records;
  }
}

void StreamCounter::end_message() {
  in_body_ = false;
  if (opcode_ == kText) {
    ++counts_.texts;
    caught_up_ |= std::exchange(text_, {}).find(R"("type":"caught_up")") != std::string::npos;
  } else if (opcode_ == kPing) {
    ++counts_.pings;
  } else if (opcode_ == kBinary) {
    ++counts_.messages;
    const unsigned char kind = frame_head_[1];
    if (kind < kGroupBegin || kind > kGroupEnd) throw std::runtime_error("an unknown frame");
    if (kind == kGroupBegin) records_before_group_ = counts_.records;
    if (kind == kGroupEnd && counts_.records > records_before_group_) ++counts_.groups;
  }
}

}  // namespace earthwork::bench
