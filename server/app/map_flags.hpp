/// What `earthwork-server map ...` was asked for.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace earthwork::app {

/// Each subcommand looks at its own.
struct MapFlags {
  std::string data = "earthwork-data";
  std::string name;
  std::string file;      ///< To export to, or import from.
  std::string new_name;  ///< Of a fork.
  std::optional<std::uint64_t> seq;
  std::optional<std::uint64_t> layer;
};

}  // namespace earthwork::app
