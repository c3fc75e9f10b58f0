/// Little-endian bytes out of memory that anybody may have filled.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace earthwork::protocol {

/// Reads from the front. Past the end, and after a varint that is no varint, it gives zeros and
/// `failed` is true from then on.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes)
      : at_(bytes.data()), end_(bytes.data() + bytes.size()) {}

  std::uint8_t u8() { return static_cast<std::uint8_t>(take<1>()); }
  std::uint16_t u16() { return static_cast<std::uint16_t>(take<2>()); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(take<4>()); }
  std::uint64_t u64() { return take<8>(); }
  std::int16_t i16() { return static_cast<std::int16_t>(u16()); }
  std::int32_t i32() { return static_cast<std::int32_t>(u32()); }
  /// At most 32 bits, in as few bytes as they need: a value has one form.
  std::uint32_t varint() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 35; shift += 7) {
      const std::uint8_t byte = u8();
      value |= std::uint64_t{byte & 0x7Fu} << shift;
      if (byte & 0x80) continue;
      if (failed_ || (byte == 0 && shift > 0) || value > UINT32_MAX) break;
      return static_cast<std::uint32_t>(value);
    }
    fail();
    return 0;
  }

  [[nodiscard]] std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }
  [[nodiscard]] bool failed() const { return failed_; }

 private:
  template <std::size_t n>
  std::uint64_t take() {
    if (remaining() < n) {
      fail();
      return 0;
    }
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < n; ++i) value |= std::to_integer<std::uint64_t>(at_[i]) << (8 * i);
    at_ += n;
    return value;
  }
  void fail() {
    failed_ = true;
    at_ = end_;
  }

  const std::byte* at_;
  const std::byte* end_;
  bool failed_ = false;
};

}  // namespace earthwork::protocol
