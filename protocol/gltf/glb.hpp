/// A map's meshes as a binary glTF file (GEOMETRY: "In glTF").
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "protocol/chunk_record.hpp"
#include "protocol/settings.hpp"

namespace earthwork::protocol {

/// Part of an export's ETag; raised when the same map gives other bytes.
inline constexpr int kExporterVersion = 1;

/// Meshes by key; the pointers are valid during the call.
using MeshMap = std::map<ChunkKey, const ChunkMesh*>;

/// The file's bytes, equal for equal arguments. Fails with too_large past 4 GiB, and with
/// internal when the writer does. Beside the result it holds the JSON part, no copy of the meshes.
[[nodiscard]] Result<std::string> write_glb(const MapSettings& settings, const MeshMap& meshes);

}  // namespace earthwork::protocol
