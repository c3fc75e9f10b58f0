#include "server/app/whole_mesh.hpp"

#include "server/room/mesh_maker.hpp"

namespace earthwork::app {

room::MeshCache mesh_whole(const voxel::Map& map, const protocol::MapSettings& settings,
                           std::uint64_t seq) {
  room::MeshMaker maker(settings.max_feature_angle);
  room::MeshCache meshes;
  for (const voxel::ChunkKey& key : map.meshed_keys())
    meshes.put(key, maker.make(key, map.neighbourhood(key), map.grid().resolution,
                               {.mesh = {}, .seen_unknown = false, .revision = seq}));
  return meshes;
}

}  // namespace earthwork::app
