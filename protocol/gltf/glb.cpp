// Two passes: the layout says how long everything is, so the file is taken once, at its size, and
// filled in place. Source: Khronos, "glTF 2.0 Specification", chapter 4.
#include "protocol/gltf/glb.hpp"

#include <bit>
#include <limits>

#include "protocol/byte_writer.hpp"
#include "protocol/gltf/glb_layout.hpp"
#include "protocol/gltf/glb_scene.hpp"
#include "protocol/gltf/wall_strip.hpp"

namespace earthwork::protocol {
namespace {

constexpr std::uint32_t kMagic = 0x46546C67, kVersion = 2;                // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;  // "JSON", "BIN"
constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;
constexpr std::uint64_t kMaxFileBytes = std::numeric_limits<std::uint32_t>::max();

tl::unexpected<Failure> too_large() {
  return fail(Code::too_large, "the map's meshes are beyond the 4 GiB of a GLB file");
}

void write_float3(const Float3& values, ByteWriter& out) {
  for (const float value : values) out.u32(std::bit_cast<std::uint32_t>(value));
}

void write_index(std::uint32_t index, std::size_t bytes, ByteWriter& out) {
  if (bytes == 4)
    out.u32(index);
  else
    out.u16(static_cast<std::uint16_t>(index));
}

void write_surface(const ChunkLayout& chunk, double top, double voxel_size, char* bin) {
  constexpr Float3 up{0, 1, 0};
  ByteWriter vertices(bin + chunk.surface->vertex_offset);
  for (const MeshPoint& vertex : chunk.mesh->vertices) {
    write_float3(glb_position(vertex, top, voxel_size), vertices);
    write_float3(up, vertices);
  }
  ByteWriter indices(bin + chunk.surface->index_offset);
  for (const std::uint16_t index : chunk.mesh->triangles) indices.u16(index);
}

/// A post's vertices are its bottom and its top; a panel's triangles face right of a -> b.
void write_wall(const ChunkLayout& chunk, const LayerSettings& layer, double voxel_size,
                char* bin) {
  const WallStrip strip = wall_strip(*chunk.mesh);
  ByteWriter vertices(bin + chunk.wall->vertex_offset);
  for (const WallPost& post : strip.posts) {
    const MeshPoint at = chunk.mesh->vertices[post.vertex];
    const Float3 normal = glb_normal(post.normal);
    for (const double height : {layer.bottom, layer.top}) {
      write_float3(glb_position(at, height, voxel_size), vertices);
      write_float3(normal, vertices);
    }
  }
  const std::size_t index_bytes = chunk.wall->index_bytes();
  ByteWriter indices(bin + chunk.wall->index_offset);
  for (const auto& [a, b] : strip.panels) {
    const std::uint32_t a_bottom = 2 * a, a_top = 2 * a + 1, b_bottom = 2 * b, b_top = 2 * b + 1;
    for (const std::uint32_t index : {a_bottom, b_bottom, b_top, a_bottom, b_top, a_top})
      write_index(index, index_bytes, indices);
  }
}

void write_bin(const MapSettings& settings, const GlbLayout& layout, char* bin) {
  for (const ChunkLayout& chunk : layout.chunks) {
    const LayerSettings& layer = settings.layers[static_cast<std::size_t>(chunk.key.layer)];
    if (chunk.surface) write_surface(chunk, layer.top, settings.voxel_size, bin);
    if (chunk.wall) write_wall(chunk, layer, settings.voxel_size, bin);
  }
}

}  // namespace

Result<std::string> write_glb(const MapSettings& settings, const MeshMap& meshes) {
  const GlbLayout layout = glb_layout(settings, meshes);
  if (layout.bytes > kMaxFileBytes) return too_large();
  auto json = glb_scene(settings, layout);
  if (!json) return json;
  json->resize((json->size() + 3) / 4 * 4, ' ');
  const std::size_t json_end = kHeaderBytes + kChunkHeaderBytes + json->size();
  const std::uint64_t size =
      json_end + (layout.bytes > 0 ? kChunkHeaderBytes + layout.bytes : std::uint64_t{0});
  if (size > kMaxFileBytes) return too_large();

  // Zeros where nothing is written: the padding between primitives.
  std::string file(static_cast<std::size_t>(size), '\0');
  ByteWriter head(file.data());
  for (const std::uint32_t word : {kMagic, kVersion, static_cast<std::uint32_t>(size),
                                   static_cast<std::uint32_t>(json->size()), kJsonChunk})
    head.u32(word);
  file.replace(kHeaderBytes + kChunkHeaderBytes, json->size(), *json);
  if (layout.bytes == 0) return file;
  ByteWriter bin(file.data() + json_end);
  bin.u32(static_cast<std::uint32_t>(layout.bytes));
  bin.u32(kBinChunk);
  write_bin(settings, layout, bin.at());
  return file;
}

}  // namespace earthwork::protocol
