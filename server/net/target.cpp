#include "server/net/target.hpp"

#include <algorithm>
#include <cctype>

namespace earthwork::net {
namespace {

/// Cuts the text before the first `separator` off, and the separator with it.
std::string_view take_until(char separator, std::string_view& text) {
  const std::size_t at = text.find(separator);
  const std::string_view head = text.substr(0, at);
  text = at == std::string_view::npos ? std::string_view{} : text.substr(at + 1);
  return head;
}

/// Cuts "http://name:80" off; nothing when the text does not begin so. A scheme's case is free.
std::optional<std::string> take_authority(std::string_view& text) {
  constexpr std::string_view kScheme = "http://";
  const auto same = [](char wanted, char given) {
    return std::tolower(static_cast<unsigned char>(given)) == wanted;
  };
  if (text.size() < kScheme.size() ||
      !std::equal(kScheme.begin(), kScheme.end(), text.begin(), same))
    return std::nullopt;
  text.remove_prefix(kScheme.size());
  const std::size_t end = std::min(text.find_first_of("/?"), text.size());
  std::string authority(text.substr(0, end));
  text.remove_prefix(end);
  return authority;
}

}  // namespace

std::optional<std::string> Target::asked(std::string_view key) const {
  const auto found = query.find(key);
  if (found == query.end()) return std::nullopt;
  return found->second;
}

std::optional<Target> parse_target(std::string_view text) {
  Target target;
  target.authority = take_authority(text);
  std::string_view path = take_until('?', text);
  if (target.authority && path.empty()) path = "/";
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
