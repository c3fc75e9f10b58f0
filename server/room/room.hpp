/// A live map: it gives edits their order, applies them, and shows them to its viewers.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "protocol/messages.hpp"
#include "protocol/settings.hpp"
#include "server/history/event.hpp"
#include "server/mesh/figures.hpp"
#include "server/room/authors.hpp"
#include "server/room/guarded_viewer.hpp"
#include "server/room/herald.hpp"
#include "server/room/line.hpp"
#include "server/room/meters.hpp"
#include "server/room/publisher.hpp"
#include "server/room/slicer.hpp"
#include "server/room/states_picture.hpp"
#include "server/room/strand.hpp"
#include "server/room/viewer.hpp"
#include "server/voxel/map.hpp"

namespace earthwork::room {

struct RoomInfo {
  std::uint64_t seq = 0, hash = 0;
  std::size_t chunks = 0;  ///< Kept: with a filled voxel or a crossing.
  std::size_t users = 0;
};

struct RoomFigures {
  std::uint64_t seq = 0, hash = 0;
  std::size_t chunks = 0;
  std::size_t voxel_bytes = 0;  ///< Of memory, for states and crossings.
  mesh::Figures geometry;
  MeshTotals meshes;
};

/// All meshes as of one seq.
struct MeshSnapshot {
  std::uint64_t seq = 0, mesh_hash = 0;
  std::vector<RecordBytes> records;  ///< In order of their keys.
};

/// How busy a room is, for who watches the server.
struct RoomLoad {
  std::size_t waiting_edits = 0;    ///< In line, with the one that is being prepared.
  std::int64_t oldest_wait_ms = 0;  ///< Of those, the one that came first; 0 when none waits.
  std::size_t owed_chunks = 0;      ///< Waiting to be sent, of all viewers together.
  std::size_t dirty_chunks = 0;     ///< Whose meshes are not up to date.
  std::size_t viewers = 0;
};

/// name, settings, epoch and strand: any thread. Everything else: on the strand only, which also
/// calls the viewers. Held by shared_ptr; a task on its strand keeps it alive.
///
/// When its own work throws, out of memory say, map and events may no longer agree: it closes with
/// `internal`, and the exception goes on to the strand. A viewer that throws is told `end` and has
/// left; nobody else notices.
class Room : public std::enable_shared_from_this<Room> {
 public:
  /// An empty map. `settings` is valid. What it does is counted in `meters`.
  Room(std::string name, protocol::MapSettings settings, std::uint64_t epoch,
       std::unique_ptr<Strand> strand, std::shared_ptr<Meters> meters);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const protocol::MapSettings& settings() const { return settings_; }
  [[nodiscard]] std::uint64_t epoch() const { return epoch_; }
  [[nodiscard]] Strand& strand() const { return *strand_; }

  struct Entrance {
    ViewerId viewer = 0;
    protocol::Joined joined;  ///< Without an id.
  };
  /// Fails with what the room was closed for.
  [[nodiscard]] protocol::Result<Entrance> join(std::shared_ptr<Viewer> viewer,
                                                protocol::User user);
  /// After it the viewer is not called again; its edits in line are applied all the same.
  void leave(ViewerId viewer);
  /// Leaves once the viewer was told what became of all its edits in line, and then calls `gone`:
  /// within the call when none waits. It is shown and told nothing else meanwhile, and is gone for
  /// the others. Should the room close first, it is told `end` in place of `gone`.
  void leave_when_told(ViewerId viewer, std::function<void()> gone);
  /// Changes what the viewer is shown; parcels follow later, never from within the call. Fails
  /// with too_large for more than kMaxViewChunks.
  [[nodiscard]] protocol::Result<void> look(ViewerId viewer, const protocol::View& view);
  /// The viewer has sent the last parcel on, and takes the next one.
  void ready(ViewerId viewer);
  /// The viewer has sent the last talk on, and takes the next one.
  void heard(ViewerId viewer);

  /// Where the viewer points, for the others. Fails as `submit` would for a stamp of its brush
  /// there, or of radius 0. Of what comes before the others are told, ten times a second, the last
  /// counts; a cursor that is not said again for kCursorMs is hidden.
  [[nodiscard]] protocol::Result<void> point(ViewerId viewer, const protocol::Cursor& cursor);
  /// Tells the viewer all events from `from_seq` on, and those to come. Fails with out_of_range
  /// beyond the next seq. Asked again, it starts anew from there.
  [[nodiscard]] protocol::Result<void> follow(ViewerId viewer, std::uint64_t from_seq);

  using Command = room::Command;
  /// Puts an edit in line. Fails when `check_edit` does, and with too_large when kMaxWaitingPoints
  /// would be exceeded; then it has no number. Otherwise the viewer is told later, never from
  /// within the call: its number, the one that it has already when the author's id was applied
  /// before, or that it has none, by id_out_of_order or id_too_old. An author's edits come to their
  /// turn in the order of submission, whichever viewers they come from. A large one takes many
  /// tasks; meanwhile others are applied and numbered before it, unless they come near its place.
  [[nodiscard]] protocol::Result<void> submit(ViewerId viewer, Command command);

  [[nodiscard]] RoomInfo info();
  [[nodiscard]] RoomLoad load() const;
  /// Brings up to `budget` chunks' meshes up to date; true when all are.
  [[nodiscard]] bool refresh_meshes(std::size_t budget) { return publisher_.refresh(budget); }
  /// After `refresh_meshes` gave true in the same task.
  [[nodiscard]] RoomFigures figures();
  [[nodiscard]] MeshSnapshot meshes() const;
  [[nodiscard]] protocol::Result<StatesPicture> states(std::uint64_t layer) const;
  /// All that was accepted, in order. Valid until the next task.
  [[nodiscard]] std::span<const history::Event> events() const { return events_; }

  /// Says `bye` to all viewers and lets nobody in again.
  void close(const protocol::Bye& bye);

 private:
  struct Seat {
    std::shared_ptr<GuardedViewer> viewer;
    std::size_t waiting = 0;     // edits in line, also aside
    std::vector<Reply> told;     // of this turn
    std::function<void()> gone;  // set: it leaves when none waits
  };

  void run(const std::function<void()>& task);
  void run_later(std::chrono::milliseconds delay, std::function<void()> task);
  [[nodiscard]] Workplace workplace();
  void schedule_turn();
  void turn();
  void take_next();
  [[nodiscard]] Reply decide(Command& command);
  void accept(Command& command, const voxel::Change& change);
  void schedule_slice();
  void slice();
  void commit_sliced();
  void answer(ViewerId viewer, Reply reply);
  void acknowledge();
  void let_go();
  [[nodiscard]] std::uint64_t seq() const { return events_.size(); }

  const std::string name_;
  const protocol::MapSettings settings_;
  const std::uint64_t epoch_;
  const std::unique_ptr<Strand> strand_;
  const std::shared_ptr<Meters> meters_;

  voxel::Map map_;
  Publisher publisher_;
  std::vector<history::Event> events_;  // event n at n - 1
  Herald herald_;
  Authors authors_;
  Line line_;
  Slicer slicer_;                // what it prepares is aside in the line
  std::size_t turn_chunks_ = 0;  // to be meshed again, of this turn, a chunk once an edit
  std::uint64_t turn_rows_ = 0;  // that this turn looked at, a row once a stamp
  std::map<ViewerId, Seat> seats_;
  ViewerId last_viewer_ = 0;
  std::optional<RoomFigures> figures_;  // the last ones asked for
  bool turn_scheduled_ = false;
  std::optional<protocol::Failure> closed_;  // why
};

}  // namespace earthwork::room
