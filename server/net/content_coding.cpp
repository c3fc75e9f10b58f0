#include "server/net/content_coding.hpp"

#include <algorithm>
#include <cctype>
#include <optional>

namespace earthwork::net {
namespace {

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
  return text.substr(0, text.find_last_not_of(" \t") + 1);
}

/// Cuts the text before the first `separator` off, and the separator with it.
std::string_view take_until(char separator, std::string_view& text) {
  const std::size_t at = text.find(separator);
  const std::string_view head = text.substr(0, at);
  text = at == std::string_view::npos ? std::string_view{} : text.substr(at + 1);
  return trimmed(head);
}

bool same(std::string_view text, std::string_view lower) {
  return std::equal(text.begin(), text.end(), lower.begin(), lower.end(), [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == b;
  });
}

/// "0", "1", "0.5", "1.000" in thousandths; 0 for what is no weight.
int weight(std::string_view text) {
  const bool whole = text == "0" || text == "1";
  const bool fraction = text.starts_with("0.") || text.starts_with("1.");
  if (text.size() > 5 || !(whole || fraction)) return 0;
  int value = 0;
  for (std::size_t i = 0, digit = 1000; i < text.size(); ++i) {
    if (i == 1) continue;  // the point
    if (text[i] < '0' || text[i] > '9') return 0;
    value += (text[i] - '0') * static_cast<int>(digit);
    digit /= 10;
  }
  return value <= 1000 ? value : 0;
}

/// Of the parameters after a coding's name.
int weight_among(std::string_view parameters) {
  while (!parameters.empty()) {
    std::string_view value = take_until(';', parameters);
    const std::string_view name = take_until('=', value);
    if (same(name, "q")) return weight(trimmed(value));
  }
  return 1000;
}

}  // namespace

bool prefers_gzip(std::string_view accept_encoding) {
  std::optional<int> gzip, any, identity;
  while (!accept_encoding.empty()) {
    std::string_view rest = take_until(',', accept_encoding);
    const std::string_view coding = take_until(';', rest);
    if (same(coding, "gzip") || same(coding, "x-gzip"))
      gzip = weight_among(rest);
    else if (coding == "*")
      any = weight_among(rest);
    else if (same(coding, "identity"))
      identity = weight_among(rest);
  }
  const int wanted = gzip.value_or(any.value_or(0));
  return wanted > 0 && wanted >= identity.value_or(0);
}

}  // namespace earthwork::net
