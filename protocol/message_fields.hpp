/// Fields that messages of both sides have.
#pragma once

#include <cstddef>
#include <optional>

#include "protocol/json_fields.hpp"
#include "protocol/messages.hpp"

namespace earthwork::protocol {

inline constexpr std::int64_t kMaxVersion = 65535;
inline constexpr std::size_t kKeyDigits = 32, kSessionDigits = 16, kEpochDigits = 16,
                             kAuthorDigits = 16, kHashDigits = 16;

inline MessageId read_id(JsonFields& in) { return in.integer("id", {1, kMaxInteger}); }

inline std::optional<MessageId> read_optional_id(JsonFields& in) {
  if (!in.has("id")) return std::nullopt;
  return read_id(in);
}

inline std::uint32_t read_u32(JsonFields& in, const char* key) {
  return static_cast<std::uint32_t>(in.integer(key, {0, UINT32_MAX}));
}

inline std::uint64_t read_seq(JsonFields& in, const char* key = "seq", std::int64_t min = 0) {
  return static_cast<std::uint64_t>(in.integer(key, {min, kMaxInteger}));
}

}  // namespace earthwork::protocol
