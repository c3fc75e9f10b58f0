#include "protocol/chunk_record.hpp"

namespace earthwork::protocol {

std::string hex(std::uint64_t value) {
  std::string digits(16, '0');
  for (auto at = digits.rbegin(); at != digits.rend(); ++at, value >>= 4)
    *at = "0123456789abcdef"[value & 15];
  return digits;
}

Result<std::uint64_t> parse_hex(std::string_view digits) {
  if (digits.size() != 16) return fail(Code::bad_field, "not 16 hex digits");
  std::uint64_t value = 0;
  for (const char c : digits) {
    const bool decimal = '0' <= c && c <= '9';
    if (!decimal && !('a' <= c && c <= 'f'))
      return fail(Code::bad_field, "not 16 hex digits in lower case");
    value = value << 4 | static_cast<std::uint64_t>(decimal ? c - '0' : c - 'a' + 10);
  }
  return value;
}

}  // namespace earthwork::protocol
