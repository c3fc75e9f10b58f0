/// What a server sends to a viewer, counted and thrown away: far cheaper than a client, so that a
/// thousand viewers leave the processor to what is measured.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace earthwork::bench {

struct StreamCounts {
  std::uint64_t messages = 0;  ///< Binary WebSocket messages.
  std::uint64_t texts = 0;
  std::uint64_t records = 0;  ///< Chunk records: what is delivered.
  std::uint64_t groups = 0;   ///< That had a record.
  std::uint64_t bytes = 0;    ///< Of records, their length fields included.
  std::uint64_t pings = 0;
  friend bool operator==(const StreamCounts&, const StreamCounts&) = default;
};

/// Hops from header to header of a WebSocket stream after its handshake, and in binary messages
/// from record to record (protocol/README.md: "Frames").
class StreamCounter {
 public:
  /// The next bytes as they were read, in any pieces. Throws std::runtime_error on what no server
  /// of this project sends: fragments, masked messages, unknown kinds.
  void feed(std::span<const unsigned char> bytes);
  [[nodiscard]] const StreamCounts& counts() const { return counts_; }
  /// A text message has said so; others may have followed it.
  [[nodiscard]] bool caught_up() const { return caught_up_; }

 private:
  std::size_t header_size() const;
  void read_header();
  void read_body(std::span<const unsigned char> bytes);
  void read_records(std::span<const unsigned char> bytes);
  void end_message();

  StreamCounts counts_;
  std::array<unsigned char, 10> header_{};
  std::size_t header_filled_ = 0;
  unsigned opcode_ = 0;
  std::uint64_t left_ = 0;  // bytes of the message
  bool in_body_ = false;
  std::array<unsigned char, 2> frame_head_{};  // version and kind
  std::size_t frame_head_filled_ = 0;
  std::array<unsigned char, 4> length_{};  // of the record
  std::size_t length_filled_ = 0;
  std::uint64_t record_left_ = 0;
  std::uint64_t records_before_group_ = 0;
  std::string text_;
  bool caught_up_ = false;
};

}  // namespace earthwork::bench
