/// Who takes part in a map: what a room tells a session, and no more.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "protocol/frame.hpp"
#include "protocol/messages.hpp"
#include "server/room/mesh_record.hpp"

namespace earthwork::room {

/// Given when a viewer joins; never used twice in one room.
using ViewerId = std::uint64_t;

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

/// A whole control message: written once, shared by all viewers that it is sent to.
using SharedText = std::shared_ptr<const std::string>;

/// What a viewer is told of people and events, beside meshes. Bounded: about kMaxTalkBytes, or one
/// message that is longer.
struct Talk {
  std::vector<SharedText> messages;
};
inline constexpr std::size_t kMaxTalkBytes = 64 * 1024;

/// The answer to an edit.
using Reply = std::variant<protocol::Applied, protocol::Rejected>;

/// Called on the room's strand; must come back at once and not call the room.
class Viewer {
 public:
  virtual ~Viewer() = default;
  /// Edits of this viewer that were decided on, in order: each has its number now, or has none
  /// because of its id. One answer for every edit that `Room::submit` took.
  virtual void answered(std::vector<Reply> replies) = 0;
  /// The next parcel comes after `Room::ready`, never before.
  virtual void deliver(Parcel parcel) = 0;
  /// The next talk comes after `Room::heard`, never before.
  virtual void tell(Talk talk) = 0;
  /// The map's layers have changed: a `settings` message, before anything is delivered that needs
  /// it. Of those that were not sent on yet only the last one counts.
  virtual void settings(SharedText message) = 0;
  /// The room is gone, and calls no more.
  virtual void end(protocol::Bye bye) = 0;
};

}  // namespace earthwork::room
