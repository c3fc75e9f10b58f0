#include "client/bot/flag_value.hpp"

#include <charconv>
#include <system_error>

#include "protocol/json_fields.hpp"

namespace earthwork::bot {
namespace {

/// Whether all of `text` is one.
template <class Number>
bool read(const std::string& text, Number& value) {
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc{} && stop == end;
}

}  // namespace

std::string check_whole(const std::string& text, std::uint64_t min, std::uint64_t max) {
  std::uint64_t value = 0;
  if (read(text, value) && value >= min && value <= max) return {};
  return "'" + text + "' is no whole number of " + std::to_string(min) + " .. " +
         std::to_string(max);
}

std::string check_number(const std::string& text, double min, double max) {
  double value = 0;
  if (read(text, value) && value >= min && value <= max) return {};  // NaN is in no range
  return "'" + text + "' is no number of " + protocol::plain(min) + " .. " + protocol::plain(max);
}

}  // namespace earthwork::bot
