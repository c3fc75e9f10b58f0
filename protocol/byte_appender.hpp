/// Little-endian bytes at the end of a string, for what is small or of unknown size.
#pragma once

#include <cstdint>
#include <string>

#include "protocol/byte_writer.hpp"

namespace earthwork::protocol {

class ByteAppender {
 public:
  explicit ByteAppender(std::string& out) : out_(out) {}

  void u8(unsigned value) { out_ += static_cast<char>(value); }
  void i16(std::int16_t value) {
    u8(static_cast<std::uint16_t>(value) & 0xFF);
    u8(static_cast<std::uint16_t>(value) >> 8);
  }
  void varint(std::uint32_t value) {
    for (; value >= 0x80; value >>= 7) u8((value & 0x7F) | 0x80);
    u8(value);
  }
  /// The difference of two numbers that fits 32 bits, as the varint of its zigzag form.
  void step(std::int64_t value) { varint(zigzag(static_cast<std::int32_t>(value))); }

 private:
  std::string& out_;
};

}  // namespace earthwork::protocol
