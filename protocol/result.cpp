#include "protocol/result.hpp"

#include <array>

namespace earthwork::protocol {
namespace {

// In the order of the enum.
constexpr std::array<std::string_view, 23> kNames{
    "bad_json",        "bad_message",   "bad_field",   "out_of_range",  "too_large", "bad_frame",
    "bad_version",     "bad_state",     "unknown_map", "map_exists",    "bad_name",  "id_too_old",
    "id_out_of_order", "not_supported", "timeout",     "shutting_down", "disk_full", "read_only",
    "storage_failed",  "damaged",       "unavailable", "too_fast",      "internal",
};
static_assert(kNames.size() == static_cast<std::size_t>(Code::internal) + 1);

}  // namespace

std::string_view name(Code code) { return kNames.at(static_cast<std::size_t>(code)); }

Code code_named(std::string_view name) {
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (kNames[i] == name) return static_cast<Code>(i);
  return Code::internal;
}

}  // namespace earthwork::protocol
