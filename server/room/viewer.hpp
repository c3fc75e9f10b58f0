/// Who takes part in a map: what a room tells a session, and no more.
#pragma once

#include <optional>
#include <vector>

#include "protocol/frame.hpp"
#include "protocol/messages.hpp"
#include "server/room/mesh_record.hpp"

namespace earthwork::room {

/// What is sent to a viewer at one go, all of it as of one seq: a group, then chunks that the
/// viewer sees for the first time, then word that its view is complete. The records are shared,
/// so a parcel that waits costs two pointers a chunk.
struct Parcel {
  std::optional<protocol::GroupBegin> group{};
  std::vector<RecordBytes> group_records{};  ///< Empty without a group.
  std::vector<RecordBytes> first_seen{};
  std::optional<protocol::CaughtUp> caught_up{};

  [[nodiscard]] bool empty() const { return !group && first_seen.empty() && !caught_up; }
};

/// Called on the room's strand; must come back at once and not call the room.
class Viewer {
 public:
  virtual ~Viewer() = default;
  /// Edits of this viewer that have their numbers now, in order.
  virtual void applied(std::vector<protocol::Applied> replies) = 0;
  /// The next parcel comes after `Room::ready`, never before.
  virtual void deliver(Parcel parcel) = 0;
  /// The room is gone, and calls no more.
  virtual void end(protocol::Bye bye) = 0;
};

}  // namespace earthwork::room
