/// Little-endian bytes into memory that is known to be large enough.
#pragma once

#include <cstddef>
#include <cstdint>

namespace earthwork::protocol {

/// The most bytes a varint takes.
inline constexpr std::size_t kMaxVarintBytes = 5;

/// Small magnitudes become small numbers: 0, -1, 1, -2 ... to 0, 1, 2, 3 ...
constexpr std::uint32_t zigzag(std::int32_t value) {
  return static_cast<std::uint32_t>(value) << 1 ^ static_cast<std::uint32_t>(value >> 31);
}
constexpr std::int32_t unzigzag(std::uint32_t value) {
  return static_cast<std::int32_t>(value >> 1 ^ (~(value & 1) + 1));
}

/// Writes from `at` on; the caller has made room.
class ByteWriter {
 public:
  explicit ByteWriter(char* at) : at_(at) {}

  void u8(unsigned value) { *at_++ = static_cast<char>(value); }
  void u16(std::uint16_t value) { bytes<2>(value); }
  void u32(std::uint32_t value) { bytes<4>(value); }
  void u64(std::uint64_t value) { bytes<8>(value); }
  void i16(std::int16_t value) { u16(static_cast<std::uint16_t>(value)); }
  void i32(std::int32_t value) { u32(static_cast<std::uint32_t>(value)); }
  /// Seven bits a byte, lowest first; the top bit says that more follow.
  void varint(std::uint32_t value) {
    for (; value >= 0x80; value >>= 7) u8((value & 0x7F) | 0x80);
    u8(value);
  }
  char* at() const { return at_; }

 private:
  template <int n>
  void bytes(std::uint64_t value) {
    for (int i = 0; i < n; ++i) at_[i] = static_cast<char>(value >> (8 * i));
    at_ += n;
  }

  char* at_;
};

}  // namespace earthwork::protocol
