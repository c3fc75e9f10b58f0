#include "tests/gltf/glb_file.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace earthwork::protocol {
namespace {

template <class T>
T at(const std::string& bytes, std::size_t offset) {
  T value{};
  EXPECT_LE(offset + sizeof(T), bytes.size());
  if (offset + sizeof(T) <= bytes.size()) std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

}  // namespace

GlbFile::GlbFile(const std::string& bytes) {
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(at<std::uint32_t>(bytes, 4), 2u);
  EXPECT_EQ(at<std::uint32_t>(bytes, 8), bytes.size());
  const std::size_t json_bytes = at<std::uint32_t>(bytes, 12);
  EXPECT_EQ(bytes.substr(16, 4), "JSON");
  EXPECT_EQ(json_bytes % 4, 0u);
  json_ = nlohmann::json::parse(bytes.substr(20, json_bytes));
  const std::size_t bin = 20 + json_bytes;
  if (bin == bytes.size()) return;
  EXPECT_EQ(at<std::uint32_t>(bytes, bin), bytes.size() - bin - 8);
  EXPECT_EQ(bytes.substr(bin + 4, 4), std::string("BIN\0", 4));
  bin_ = bytes.substr(bin + 8);
  EXPECT_EQ(json_["buffers"][0]["byteLength"], bin_.size());
}

const nlohmann::json& GlbFile::node(const std::string& name) const {
  for (const auto& node : json_["nodes"])
    if (node["name"] == name) return node;
  ADD_FAILURE() << "no node " << name;
  static const nlohmann::json none;
  return none;
}

std::vector<GlbPrimitive> GlbFile::primitives(const std::string& node_name) const {
  std::vector<GlbPrimitive> primitives;
  const auto& mesh = json_["meshes"][node(node_name)["mesh"].get<std::size_t>()];
  for (const auto& primitive : mesh["primitives"]) {
    const int index = primitive["indices"];
    const auto& accessor = json_["accessors"][static_cast<std::size_t>(index)];
    primitives.push_back({json_["materials"][primitive["material"].get<std::size_t>()]["name"],
                          vectors(primitive["attributes"]["POSITION"]),
                          vectors(primitive["attributes"]["NORMAL"]), indices(index),
                          accessor["componentType"]});
  }
  return primitives;
}

std::vector<std::array<float, 3>> GlbFile::vectors(int index) const {
  const auto& accessor = json_["accessors"][static_cast<std::size_t>(index)];
  const auto& view = json_["bufferViews"][accessor["bufferView"].get<std::size_t>()];
  EXPECT_EQ(accessor["componentType"], 5126);
  EXPECT_EQ(view["target"], 34962);
  std::vector<std::array<float, 3>> vectors(accessor["count"].get<std::size_t>());
  std::size_t offset =
      view.value("byteOffset", std::size_t{0}) + accessor.value("byteOffset", std::size_t{0});
  for (auto& vector : vectors) {
    for (std::size_t i = 0; i < 3; ++i) vector[i] = at<float>(bin_, offset + 4 * i);
    offset += view["byteStride"].get<std::size_t>();
  }
  return vectors;
}

std::vector<std::uint32_t> GlbFile::indices(int index) const {
  const auto& accessor = json_["accessors"][static_cast<std::size_t>(index)];
  const auto& view = json_["bufferViews"][accessor["bufferView"].get<std::size_t>()];
  EXPECT_EQ(view["target"], 34963);
  const bool wide = accessor["componentType"] == 5125;
  std::vector<std::uint32_t> indices(accessor["count"].get<std::size_t>());
  const std::size_t offset = view.value("byteOffset", std::size_t{0});
  for (std::size_t i = 0; i < indices.size(); ++i)
    indices[i] =
        wide ? at<std::uint32_t>(bin_, offset + 4 * i) : at<std::uint16_t>(bin_, offset + 2 * i);
  return indices;
}

}  // namespace earthwork::protocol
