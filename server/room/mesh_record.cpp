#include "server/room/mesh_record.hpp"

namespace earthwork::room {
namespace {

protocol::MeshNormal to_protocol(const voxel::Normal& n) { return {n.x, n.y}; }

}  // namespace

protocol::ChunkKey to_protocol(const voxel::ChunkKey& key) {
  return {key.layer, key.x, key.y, key.z};
}

protocol::ChunkMesh to_protocol(const mesh::ChunkMesh& mesh) {
  protocol::ChunkMesh out;
  out.vertices.reserve(mesh.vertices.size());
  for (const mesh::Point& p : mesh.vertices) out.vertices.push_back({p.x, p.y});
  out.triangles = mesh.triangles;
  out.sections.reserve(mesh.sections.size());
  for (const mesh::Section& s : mesh.sections)
    out.sections.push_back({s.a, s.b, to_protocol(s.normal_a), to_protocol(s.normal_b)});
  return out;
}

}  // namespace earthwork::room
