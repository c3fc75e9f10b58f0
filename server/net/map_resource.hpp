/// What HTTP shows of one map: its description, figures, voxel states and mesh.
///
/// Each function answers through `respond`, later and from another thread. Meshes are brought up to
/// date on the room's strand in pieces, so that edits get between; then figures are counted, states
/// drawn and records listed there in one piece each, which for a large map holds up its editors.
/// Files are encoded by the workers, from copies; when those have too much to do the answer is 503,
/// before a picture is drawn.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "server/net/http_message.hpp"
#include "server/net/workers.hpp"
#include "server/room/room.hpp"

namespace earthwork::net {

using RoomPointer = std::shared_ptr<room::Room>;

/// The map's description with `status`: GET and POST give the same one.
void describe_map(const RoomPointer& room, int status, Respond respond);

void give_figures(const RoomPointer& room, Respond respond);

/// A PNG of layer `layer`.
void give_states(const RoomPointer& room, std::uint64_t layer, Workers& workers, Respond respond);

struct ExportQuestion {
  std::optional<std::uint64_t> seq;          ///< Only the map as it is now can be had.
  std::optional<std::string> if_none_match;  ///< The header as it came.
};
/// The meshes as a GLB file, with an ETag; 304 when the asker has it.
void give_export(const RoomPointer& room, ExportQuestion question, Workers& workers,
                 Respond respond);

}  // namespace earthwork::net
