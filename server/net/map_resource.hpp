/// What HTTP shows of one map: its description, figures, voxel states and mesh.
///
/// Each function gives its answer later and from another thread, and only once all that it shows is
/// stored. Meshes are brought up to date on the room's strand in pieces, so that edits get between;
/// then figures are counted, states drawn and records listed there in one piece each, which for a
/// large map holds up its editors. Files are encoded by the workers, from copies; when those have
/// too much to do the answer is 503, before a picture is drawn.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "server/net/http_message.hpp"
#include "server/net/map_question.hpp"
#include "server/net/workers.hpp"
#include "server/room/room.hpp"

namespace earthwork::net {

/// The map's description with `status`: GET and POST give the same one.
void describe_map(const RoomPointer& room, int status, Given give);

void give_figures(const RoomPointer& room, Given give);

/// A PNG of layer `layer`.
void give_states(const RoomPointer& room, std::uint64_t layer, Workers& workers, Given give);

struct ExportQuestion {
  std::optional<std::uint64_t> seq;          ///< Only the map as it is now can be had.
  std::optional<std::string> if_none_match;  ///< The header as it came.
};
/// The meshes as a GLB file, with an ETag; 304 when the asker has it.
void give_export(const RoomPointer& room, ExportQuestion question, Workers& workers, Given give);

}  // namespace earthwork::net
