#include "server/net/target.hpp"

namespace earthwork::net {
namespace {

/// Cuts the text before the first `separator` off, and the separator with it.
std::string_view take_until(char separator, std::string_view& text) {
  const std::size_t at = text.find(separator);
  const std::string_view head = text.substr(0, at);
  text = at == std::string_view::npos ? std::string_view{} : text.substr(at + 1);
  return head;
}

}  // namespace

std::optional<std::string> Target::asked(std::string_view key) const {
  const auto found = query.find(key);
  if (found == query.end()) return std::nullopt;
  return found->second;
}

std::optional<Target> parse_target(std::string_view text) {
  Target target;
  std::string_view path = take_until('?', text);
  if (path.empty() || path.front() != '/' || path.find('%') != std::string_view::npos)
    return std::nullopt;

  path.remove_prefix(1);
  if (path.ends_with('/')) return std::nullopt;
  while (!path.empty()) {
    const std::string_view segment = take_until('/', path);
    if (segment.empty() || segment == "." || segment == "..") return std::nullopt;
    target.segments.emplace_back(segment);
  }
  while (!text.empty()) {
    std::string_view value = take_until('&', text);
    const std::string_view key = take_until('=', value);
    target.query.insert_or_assign(std::string(key), std::string(value));
  }
  return target;
}

}  // namespace earthwork::net
