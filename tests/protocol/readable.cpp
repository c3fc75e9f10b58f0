#include "tests/protocol/readable.hpp"

#include <cctype>
#include <sstream>

namespace earthwork::protocol {
namespace {

std::ostream& operator<<(std::ostream& out, MeshNormal normal) {
  return out << "(" << normal.x << ", " << normal.y << ")";
}

/// Items after a heading, `per_line` in a line.
template <class List, class Write>
void list(std::ostream& out, const char* heading, const List& items, std::size_t per_line,
          Write write) {
  out << "# " << heading << ": " << items.size();
  for (std::size_t i = 0; i < items.size(); ++i) {
    out << (i % per_line == 0 ? "\n#   " : "  ");
    write(items[i]);
  }
  out << "\n";
}

bool is_pair(std::string_view word) {
  return word.size() == 2 && std::isxdigit(static_cast<unsigned char>(word[0])) &&
         std::isxdigit(static_cast<unsigned char>(word[1]));
}

void read_line(const std::string& line, std::string& bytes) {
  std::istringstream words(line);
  for (std::string word; words >> word && is_pair(word);)
    bytes += static_cast<char>(std::stoi(word, nullptr, 16));
}

}  // namespace

std::string readable(const GroupBegin& begin) {
  return "# group begin: epoch " + hex(begin.epoch) + ", seq " + std::to_string(begin.seq) +
         ", view " + std::to_string(begin.view) + "\n";
}

std::string readable(const GroupEnd& end) {
  return "# group end: seq " + std::to_string(end.seq) + "\n";
}

std::string readable(const ChunkRecord& record) {
  std::ostringstream out;
  out << "# " << (record.removed ? "removed" : "full") << " chunk of layer " << record.key.layer
      << " at (" << record.key.x << ", " << record.key.y << ", " << record.key.z << "), revision "
      << record.revision << "\n";
  if (record.removed) return out.str();
  out << "# twice the area " << twice_area(record.mesh) << ", mesh hash "
      << hex(mesh_hash(record.mesh)) << "\n";
  list(out, "vertices", record.mesh.vertices, 6,
       [&](MeshPoint p) { out << "(" << p.x << ", " << p.y << ")"; });
  list(out, "triangle indices", record.mesh.triangles, 15, [&](std::uint16_t i) { out << i; });
  list(out, "wall sections", record.mesh.sections, 1, [&](const WallSection& section) {
    out << section.a << " -> " << section.b << "  normals " << section.normal_a << " "
        << section.normal_b;
  });
  return out.str();
}

std::string hex_dump(std::string_view bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    text += hex(static_cast<unsigned char>(bytes[i])).substr(14);
    text += i % 16 == 15 || i + 1 == bytes.size() ? '\n' : ' ';
  }
  return text;
}

std::string read_hex(std::string_view text) {
  std::string bytes;
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) read_line(line, bytes);
  return bytes;
}

}  // namespace earthwork::protocol
