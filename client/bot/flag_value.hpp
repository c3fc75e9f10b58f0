/// What stands behind a flag on the command line. Each function gives back what is wrong with
/// `text`, for people, and nothing when it is well.
#pragma once

#include <cstdint>
#include <string>

namespace earthwork::bot {

/// Decimal digits, `min` .. `max`; no sign, no other base.
[[nodiscard]] std::string check_whole(const std::string& text, std::uint64_t min,
                                      std::uint64_t max);
/// A finite decimal number, `min` .. `max`.
[[nodiscard]] std::string check_number(const std::string& text, double min, double max);

}  // namespace earthwork::bot
