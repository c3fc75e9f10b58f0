/// The rooms of the project and the direction in which they include each other.
///
/// The drawing stands in README.md, under "Rooms"; the table in rooms.cpp is that drawing.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/house/source_tree.hpp"

namespace earthwork::house {

struct Room {
  std::string_view folder;                  ///< Also the room's name.
  std::vector<std::string_view> arrows;     ///< The rooms it may include.
  std::vector<std::string_view> libraries;  ///< Prefixes of the headers it may take from outside.
  bool pure = false;  ///< No clock, thread, log or I/O of the standard library either.
};

/// All rooms that there may be.
const std::vector<Room>& rooms();

/// The room whose folder holds the file itself; null when there is none.
const Room* room_of(std::string_view path);

/// Each include of a C++ file of a room that no arrow allows: of another room, of a library, of a
/// path that does not start at the root, of the heavy bodies that headers must not pull in. A file
/// in no room is a finding itself. Files in tests/ see everything; `known` holds all paths.
Findings check_includes(const TextFile& file, const std::set<std::string_view>& known);

}  // namespace earthwork::house
