#include "server/net/glb_export.hpp"

#include <xxhash.h>

#include <list>
#include <nlohmann/json.hpp>

#include "protocol/chunk_record.hpp"
#include "protocol/gltf/glb.hpp"

namespace earthwork::net {

std::string export_tag(const protocol::MapSettings& settings, std::uint64_t mesh_hash) {
  const std::string written = protocol::write_settings(settings).dump();
  return "\"" + protocol::hex(mesh_hash) + "-" +
         protocol::hex(XXH3_64bits(written.data(), written.size())) + "-" +
         std::to_string(protocol::kExporterVersion) + "\"";
}

protocol::Result<std::string> make_glb(const protocol::MapSettings& settings,
                                       std::span<const room::RecordBytes> records) {
  std::list<protocol::ChunkRecord> decoded;
  protocol::MeshMap meshes;
  for (const room::RecordBytes& bytes : records) {
    auto record = protocol::decode_record(std::as_bytes(std::span(*bytes)));
    if (!record) return tl::unexpected<protocol::Failure>(std::move(record.error()));
    decoded.push_back(std::move(*record));
    meshes[decoded.back().key] = &decoded.back().mesh;
  }
  return protocol::write_glb(settings, meshes);
}

}  // namespace earthwork::net
