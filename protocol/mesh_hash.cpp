#define XXH_INLINE_ALL
#include <xxhash.h>

#include <string>

#include "protocol/byte_writer.hpp"
#include "protocol/chunk_record.hpp"

namespace earthwork::protocol {

std::uint64_t twice_area(const ChunkMesh& mesh) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3) {
    const MeshPoint a = mesh.vertices[mesh.triangles[i]];
    const MeshPoint b = mesh.vertices[mesh.triangles[i + 1]];
    const MeshPoint c = mesh.vertices[mesh.triangles[i + 2]];
    sum += std::int64_t{b.x - a.x} * (c.y - a.y) - std::int64_t{b.y - a.y} * (c.x - a.x);
  }
  return static_cast<std::uint64_t>(sum);
}

std::uint64_t mesh_hash(const ChunkMesh& mesh) {
  constexpr std::size_t kSectionBytes = 24;
  std::string bytes(sizeof(std::uint64_t) + mesh.sections.size() * kSectionBytes, '\0');
  ByteWriter out(bytes.data());
  out.u64(twice_area(mesh));
  for (const WallSection& section : mesh.sections) {
    for (const std::uint16_t end : {section.a, section.b}) {
      out.i32(mesh.vertices[end].x);
      out.i32(mesh.vertices[end].y);
    }
    for (const MeshNormal normal : {section.normal_a, section.normal_b}) {
      out.i16(normal.x);
      out.i16(normal.y);
    }
  }
  return XXH3_64bits(bytes.data(), bytes.size());
}

std::uint64_t mesh_hash_term(const ChunkKey& key, std::uint64_t chunk_hash) {
  char bytes[24];
  ByteWriter out(bytes);
  for (const std::int32_t part : {key.layer, key.x, key.y, key.z}) out.i32(part);
  out.u64(chunk_hash);
  return XXH3_64bits(bytes, sizeof bytes);
}

}  // namespace earthwork::protocol
