/// A GLB file taken apart again, by hand: the tests share no code with the writer.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace earthwork::protocol {

struct GlbPrimitive {
  std::string material;
  std::vector<std::array<float, 3>> positions, normals;
  std::vector<std::uint32_t> indices;
  int index_type = 0;
};

class GlbFile {
 public:
  /// Adds a test failure for a header or chunk that is not as the specification has it.
  explicit GlbFile(const std::string& bytes);

  const nlohmann::json& json() const { return json_; }
  /// The node of that name; a test failure and null when there is none.
  const nlohmann::json& node(const std::string& name) const;
  std::vector<GlbPrimitive> primitives(const std::string& node_name) const;

 private:
  std::vector<std::array<float, 3>> vectors(int accessor) const;
  std::vector<std::uint32_t> indices(int accessor) const;

  nlohmann::json json_;
  std::string bin_;
};

}  // namespace earthwork::protocol
