/// Binary messages as text that a person can read, and back.
#pragma once

#include <string>
#include <string_view>

#include "protocol/frame.hpp"

namespace earthwork::protocol {

/// Lines that begin with '#': everything that the value holds.
std::string readable(const GroupBegin& begin);
std::string readable(const GroupEnd& end);
std::string readable(const ChunkRecord& record);
/// Lines of 16 bytes, two hex digits each.
std::string hex_dump(std::string_view bytes);
/// The bytes of a dump: in each line the pairs of hex digits before the first other word; lines
/// that begin with '#' say nothing.
std::string read_hex(std::string_view text);

}  // namespace earthwork::protocol
