#include "tests/house/rooms.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace earthwork::house {
namespace {

// What the standard library offers beyond plain computation. Counting who shares a value is not
// among it: std::shared_ptr does the same.
constexpr std::array<std::string_view, 21> kImpure = {
    "barrier",      "chrono",     "condition_variable",
    "cstdio",       "ctime",      "future",
    "fstream",      "iostream",   "istream",
    "latch",        "locale",     "mutex",
    "ostream",      "print",      "random",
    "shared_mutex", "stop_token", "thread",
    "csignal",      "cfenv",      "filesystem"};

// Bodies that cost every includer seconds: they belong into .cpp files.
constexpr std::array<std::string_view, 5> kHeavy = {"nlohmann/json.hpp", "boost/beast",
                                                    "boost/asio.hpp", "tiny_gltf.h", "CLI/"};
// A layer of Beast's own stream has to name Beast; one .cpp file includes it.
constexpr std::array<std::string_view, 1> kBeastLayers = {"server/net/buffered_socket.hpp"};

struct Include {
  std::string_view path;
  bool quoted;
};

std::optional<Include> parse_include(std::string_view line) {
  const auto skip_spaces = [&] {
    line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
  };
  skip_spaces();
  if (!line.starts_with('#')) return std::nullopt;
  line.remove_prefix(1);
  skip_spaces();
  if (!line.starts_with("include")) return std::nullopt;
  line.remove_prefix(7);
  skip_spaces();
  if (line.empty() || (line[0] != '"' && line[0] != '<')) return std::nullopt;
  const bool quoted = line[0] == '"';
  line.remove_prefix(1);
  return Include{line.substr(0, line.find(quoted ? '"' : '>')), quoted};
}

bool starts_with_any(std::string_view text, const auto& prefixes) {
  return std::any_of(std::begin(prefixes), std::end(prefixes),
                     [&](std::string_view prefix) { return text.starts_with(prefix); });
}

bool contains(const auto& list, std::string_view item) {
  return std::find(std::begin(list), std::end(list), item) != std::end(list);
}

std::string check_own(const Room& room, std::string_view path,
                      const std::set<std::string_view>& known) {
  if (!known.contains(path)) {
    return "no such file; project includes start at the root";
  }
  const Room* other = room_of(path);
  if (other == nullptr) return "that file is in no room";
  if (other == &room || contains(room.arrows, other->folder)) return {};
  return "no arrow from " + std::string(room.folder) + " to " + std::string(other->folder);
}

std::string check_library(const Room& room, std::string_view path, std::string_view includer) {
  const bool light = includer.ends_with(".hpp") && !contains(kBeastLayers, includer);
  if (light && starts_with_any(path, kHeavy)) return "too heavy for a header";
  const bool standard = path.find_first_of("./") == std::string_view::npos;
  if (standard && room.pure && contains(kImpure, path)) {
    return std::string(room.folder) + " is pure: no clock, thread, log or I/O";
  }
  if (standard || starts_with_any(path, room.libraries)) return {};
  return std::string(room.folder) + " does not use that library";
}

}  // namespace

const std::vector<Room>& rooms() {
  static const std::vector<Room> table = {
      {"protocol", {}, {"nlohmann/", "tl/", "xxhash.h"}},
      {"protocol/gltf", {"protocol"}, {"nlohmann/", "tl/", "tiny_gltf.h"}},
      {"server/voxel", {}, {"xxhash.h"}, true},
      {"server/mesh", {"server/voxel"}, {"xxhash.h"}, true},
      {"server/history", {"server/mesh", "server/voxel", "protocol"}, {}},
      {"server/journal",
       {"server/history", "server/voxel", "protocol"},
       {"sqlite3.h", "nlohmann/", "xxhash.h", "spdlog/", "fmt/", "fcntl.h", "sys/", "unistd.h"}},
      {"server/room",
       {"server/journal", "server/history", "server/mesh", "server/voxel", "protocol"},
       {"boost/", "spdlog/", "fmt/", "unistd.h"}},
      {"server/net",
       {"server/room", "protocol", "protocol/gltf"},
       {"boost/", "nlohmann/", "tl/", "spdlog/", "fmt/", "png.h", "prometheus/", "sodium.h",
        "sys/resource.h", "unistd.h", "xxhash.h"}},
      {"server/app",
       {"server/net", "server/room", "server/journal", "server/history", "server/mesh",
        "server/voxel", "protocol", "protocol/gltf"},
       {"boost/", "CLI/", "nlohmann/", "spdlog/", "fmt/", "sys/resource.h"}},
      {"client/scene", {"protocol"}, {"tl/"}},
      {"client/link", {"protocol"}, {"boost/", "nlohmann/", "tl/"}},
      {"client/bot",
       {"client/scene", "client/link", "protocol", "protocol/gltf"},
       {"boost/", "CLI/", "nlohmann/", "tl/", "fmt/", "png.h", "sys/resource.h"}},
      {"client/replay",
       {"client/scene", "client/link", "server/history", "protocol"},
       {"boost/", "CLI/", "nlohmann/", "tl/", "fmt/"}},
      {"client/viewer", {"client/scene", "client/link", "protocol"}, {"nlohmann/", "tl/"}},
      {"client/viewer/render",
       {"client/viewer", "client/scene", "protocol"},
       {"epoxy/", "EGL/", "GLES3/", "tl/"}},
      {"client/viewer/web",
       {"client/viewer", "client/viewer/render", "client/scene", "protocol"},
       {"emscripten/", "emscripten.h", "GLES3/", "nlohmann/", "tl/"}},
  };
  return table;
}

const Room* room_of(std::string_view path) {
  const std::string_view folder = path.substr(0, path.rfind('/'));
  const auto it = std::find_if(rooms().begin(), rooms().end(),
                               [&](const Room& room) { return room.folder == folder; });
  return it == rooms().end() ? nullptr : &*it;
}

Findings check_includes(const TextFile& file, const std::set<std::string_view>& known) {
  if (!is_cpp(file.path) || file.path.starts_with("tests/")) return {};
  const Room* room = room_of(file.path);
  if (room == nullptr) return {finding(file, 0, "this folder is no room that the table knows")};
  Findings findings;
  std::size_t number = 0;
  for (const std::string_view line : lines_of(file.text)) {
    ++number;
    const auto include = parse_include(line);
    if (!include) continue;
    const std::string wrong = include->quoted ? check_own(*room, include->path, known)
                                              : check_library(*room, include->path, file.path);
    if (wrong.empty()) continue;
    findings.push_back(finding(file, number, std::string(include->path) + ": " + wrong));
  }
  return findings;
}

}  // namespace earthwork::house
