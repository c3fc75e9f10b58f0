// tinygltf builds and writes the JSON. It is given no buffer: its own writer of GLB files would
// hold the mesh four times over (the model's buffer, a copy to write from, the stream, and the
// stream's string). The one line about the buffer is put in here, the bytes in glb.cpp.
#include "protocol/gltf/glb_scene.hpp"

#include <tiny_gltf.h>

#include <cmath>
#include <sstream>
#include <utility>

namespace earthwork::protocol {
namespace {

/// The linear value of an sRGB component given as two hex digits, to six decimals: no library's
/// last bit shows in the file.
double linear(const std::string& color, std::size_t digit) {
  const double srgb = std::stoi(color.substr(digit, 2), nullptr, 16) / 255.0;
  const double value = srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
  return std::round(value * 1e6) / 1e6;
}

class SceneBuilder {
 public:
  SceneBuilder(const MapSettings& settings, const GlbLayout& layout)
      : settings_(settings), layout_(layout) {
    model_.asset.version = "2.0";
    model_.asset.generator = "earthwork";
    model_.scenes.resize(1);
    model_.scenes[0].name = "map";
    model_.defaultScene = 0;
  }

  tinygltf::Model build() {
    std::size_t next = 0;
    for (std::size_t layer = 0; layer < settings_.layers.size(); ++layer) {
      layer_ = &settings_.layers[layer];
      materials_ = {-1, -1};
      const int node = add_layer();
      for (; next < layout_.chunks.size(); ++next) {
        const ChunkLayout& chunk = layout_.chunks[next];
        if (chunk.key.layer != static_cast<std::int32_t>(layer)) break;
        const int child = add_chunk(chunk);
        model_.nodes[static_cast<std::size_t>(node)].children.push_back(child);
      }
    }
    return std::move(model_);
  }

 private:
  /// Appends to one of the model's lists and gives back the index.
  template <class T>
  static int add(std::vector<T>& list, T item) {
    list.push_back(std::move(item));
    return static_cast<int>(list.size() - 1);
  }

  int add_layer() {
    tinygltf::Node node;
    node.name = layer_->name;
    // What the meshes of the layer were made with; it also tells a layer without any from a node
    // that somebody forgot.
    tinygltf::Value::Object extras;
    extras["color"] = tinygltf::Value(layer_->color);
    extras["wall"] = tinygltf::Value(
        tinygltf::Value::Array{tinygltf::Value(layer_->bottom), tinygltf::Value(layer_->top)});
    node.extras = tinygltf::Value(std::move(extras));
    const int index = add(model_.nodes, std::move(node));
    model_.scenes[0].nodes.push_back(index);
    return index;
  }

  int add_chunk(const ChunkLayout& chunk) {
    const double side = settings_.chunk_resolution * settings_.voxel_size;
    tinygltf::Node node;
    node.name = "chunk_" + std::to_string(chunk.key.x) + "_" + std::to_string(chunk.key.y);
    node.translation = {chunk.key.x * side, 0, 0 - chunk.key.y * side};
    tinygltf::Mesh mesh;
    if (chunk.surface) mesh.primitives.push_back(primitive(*chunk.surface, kSurface));
    if (chunk.wall) mesh.primitives.push_back(primitive(*chunk.wall, kWall));
    node.mesh = add(model_.meshes, std::move(mesh));
    return add(model_.nodes, std::move(node));
  }

  enum Part : std::size_t { kSurface, kWall };

  tinygltf::Primitive primitive(const PrimitiveLayout& layout, Part part) {
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = material(part);
    const int vertices = add_view(layout.vertex_offset, layout.vertices * kGlbVertexBytes,
                                  TINYGLTF_TARGET_ARRAY_BUFFER);
    tinygltf::Accessor position = accessor(vertices, layout.vertices, TINYGLTF_TYPE_VEC3);
    position.minValues.assign(layout.min.begin(), layout.min.end());
    position.maxValues.assign(layout.max.begin(), layout.max.end());
    tinygltf::Accessor normal = accessor(vertices, layout.vertices, TINYGLTF_TYPE_VEC3);
    normal.byteOffset = kGlbVertexBytes / 2;
    primitive.attributes["POSITION"] = add(model_.accessors, std::move(position));
    primitive.attributes["NORMAL"] = add(model_.accessors, std::move(normal));
    const int indices = add_view(layout.index_offset, layout.indices * layout.index_bytes(),
                                 TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    tinygltf::Accessor index = accessor(indices, layout.indices, TINYGLTF_TYPE_SCALAR);
    index.componentType = layout.index_bytes() == 4 ? TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT
                                                    : TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
    primitive.indices = add(model_.accessors, std::move(index));
    return primitive;
  }

  int add_view(std::size_t offset, std::size_t bytes, int target) {
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = offset;
    view.byteLength = bytes;
    view.target = target;
    if (target == TINYGLTF_TARGET_ARRAY_BUFFER) view.byteStride = kGlbVertexBytes;
    return add(model_.bufferViews, std::move(view));
  }

  static tinygltf::Accessor accessor(int view, std::size_t count, int type) {
    tinygltf::Accessor accessor;
    accessor.bufferView = view;
    accessor.count = count;
    accessor.type = type;
    accessor.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
    return accessor;
  }

  /// The layer's material for that part, made when it is first needed: an unused one is an error
  /// to those who read carefully.
  int material(Part part) {
    int& index = materials_[part];
    if (index >= 0) return index;
    tinygltf::Material material;
    material.name = part == kSurface ? "surface" : "wall";
    const std::string& color = layer_->color;
    material.pbrMetallicRoughness.baseColorFactor = {linear(color, 1), linear(color, 3),
                                                     linear(color, 5), 1};
    material.pbrMetallicRoughness.metallicFactor = 0;
    return index = add(model_.materials, std::move(material));
  }

  const MapSettings& settings_;
  const GlbLayout& layout_;
  tinygltf::Model model_;
  const LayerSettings* layer_ = nullptr;
  std::array<int, 2> materials_{-1, -1};
};

}  // namespace

Result<std::string> glb_scene(const MapSettings& settings, const GlbLayout& layout) {
  const tinygltf::Model model = SceneBuilder(settings, layout).build();
  std::ostringstream stream;
  const bool pretty = false, binary = false;
  if (!tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, stream, pretty, binary))
    return fail(Code::internal, "the glTF writer failed");
  std::string json = std::move(stream).str();
  if (json.empty() || json[0] != '{') return fail(Code::internal, "the glTF writer failed");
  if (layout.bytes > 0)
    json.insert(1, "\"buffers\":[{\"byteLength\":" + std::to_string(layout.bytes) + "}],");
  return json;
}

}  // namespace earthwork::protocol
