/// The target of an HTTP request, taken apart.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace earthwork::net {

/// "/api/maps/x?seq=3" is {"api", "maps", "x"} and {seq: 3}; "/" has no segment. Nothing is
/// decoded: no path and no query of this server needs an escape, so one that has some is simply
/// not known.
struct Target {
  std::vector<std::string> segments;
  std::map<std::string, std::string, std::less<>> query;  ///< Of equal keys the last one.
  /// "name:80" of "http://name:80/x", as requests to a proxy are written; it stands for the Host
  /// header then, whatever that says. Source: RFC 9112, 3.2.2.
  std::optional<std::string> authority;

  [[nodiscard]] std::optional<std::string> asked(std::string_view key) const;
};

/// Nothing when the text starts neither with '/' nor with "http://", or has an empty, "." or ".."
/// segment, or an escape in its path.
[[nodiscard]] std::optional<Target> parse_target(std::string_view text);

}  // namespace earthwork::net
