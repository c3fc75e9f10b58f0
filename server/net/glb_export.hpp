/// The mesh of a map as a file, made from the records that its viewers are sent.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "protocol/result.hpp"
#include "protocol/settings.hpp"
#include "server/room/mesh_record.hpp"

namespace earthwork::net {

/// The file's ETag, quotes included: the same for the same bytes, and known without making them.
[[nodiscard]] std::string export_tag(const protocol::MapSettings& settings,
                                     std::uint64_t mesh_hash);

/// A binary glTF file of all `records`. Fails as `protocol::write_glb` does. Takes long: holds the
/// meshes once beside the result.
[[nodiscard]] protocol::Result<std::string> make_glb(const protocol::MapSettings& settings,
                                                     std::span<const room::RecordBytes> records);

}  // namespace earthwork::net
