/// A live map: it gives edits, and changes of its layers, their order, applies them, and shows them
/// to its viewers.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "protocol/messages.hpp"
#include "protocol/settings.hpp"
#include "server/mesh/figures.hpp"
#include "server/room/edit_desk.hpp"
#include "server/room/herald.hpp"
#include "server/room/keyframer.hpp"
#include "server/room/ledger.hpp"
#include "server/room/meters.hpp"
#include "server/room/opening.hpp"
#include "server/room/past_events.hpp"
#include "server/room/publisher.hpp"
#include "server/room/seats.hpp"
#include "server/room/settings_book.hpp"
#include "server/room/states_picture.hpp"
#include "server/room/strand.hpp"
#include "server/room/viewer.hpp"
#include "server/voxel/map.hpp"

namespace earthwork::room {

/// What is durable.
struct RoomInfo {
  std::uint64_t seq = 0, hash = 0;
  protocol::MapSettings settings;
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

/// All meshes, and the settings, as of one seq.
struct MeshSnapshot {
  std::uint64_t seq = 0, mesh_hash = 0;
  protocol::MapSettings settings;
  std::vector<RecordBytes> records;  ///< In order of their keys.
};

/// How busy a room is, for who watches the server.
struct RoomLoad {
  std::size_t waiting_edits = 0;    ///< In line, with the one that is being prepared.
  std::int64_t oldest_wait_ms = 0;  ///< Of those, the one that came first; 0 when none waits.
  std::size_t owed_chunks = 0;      ///< Waiting to be sent, of all viewers together.
  std::size_t dirty_chunks = 0;     ///< Changed, and not meshed again yet.
  std::size_t viewers = 0;
};

/// name, settings, epoch and strand: any thread. Everything else: on the strand only, which also
/// calls the viewers. Held by shared_ptr; a task on its strand keeps it alive. Its end waits until
/// the clerk has done what it was given.
///
/// An edit is applied in its turn, and is durable when the batch that it goes into the journal with
/// is. Only then its author is told so, and the others are shown it. So it is with a change of
/// layers, which all who are inside are then told, before they are shown anything that is later.
/// When the batch cannot be stored, all that is not durable is taken back; those edits and all in
/// line are refused with the journal's code, and whoever comes within kPauseMs too. Viewers stay.
/// Should the journal turn out to be what it should not be (bad_state, damaged), the room closes:
/// whoever comes again finds what was stored.
///
/// When its own work throws, out of memory say, map and events may no longer agree: it closes with
/// `internal`, and the exception goes on to the strand. A viewer that throws is told `end` and has
/// left; nobody else notices.
class Room : public std::enable_shared_from_this<Room> {
 public:
  /// What it does is counted in `meters`.
  Room(std::string name, Opening opening, std::unique_ptr<Strand> strand,
       std::shared_ptr<Meters> meters);
  ~Room();
  Room(const Room&) = delete;
  Room& operator=(const Room&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  /// As of the last event that is durable.
  [[nodiscard]] protocol::MapSettings settings() const { return *settings_.durable(); }
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
  /// Leaves once the viewer was told what became of all its edits, and then calls `gone`: within
  /// the call when it was. It is shown and told nothing else meanwhile, and is gone for the others.
  /// Should the room close first, it is told `end` in place of `gone`.
  void leave_when_told(ViewerId viewer, std::function<void()> gone);
  /// Changes what the viewer is shown; parcels follow later, never from within the call. Fails
  /// with too_large for more than kMaxViewChunks.
  [[nodiscard]] protocol::Result<void> look(ViewerId viewer, const protocol::View& view);
  /// The viewer has sent the last parcel on, and takes the next one.
  void ready(ViewerId viewer);
  /// The viewer has sent the last talk on, and takes the next one.
  void heard(ViewerId viewer);

  /// Where the viewer points, for the others. Fails as `check_edit` does, with the durable
  /// settings, for a stamp of its brush there, or of radius 0, and as `check_seen` for what it
  /// sees. Of what comes before the others are told, ten times a second, the last counts; a cursor
  /// that is not said again for kCursorMs is hidden.
  [[nodiscard]] protocol::Result<void> point(ViewerId viewer, const protocol::Cursor& cursor);
  /// Says something to all who are inside, the viewer too, and to who will join: 1 to
  /// kMaxChatCharacters characters.
  [[nodiscard]] protocol::Result<void> say(ViewerId viewer, std::string text);
  /// Tells the viewer all events from `from_seq` on, and those to come. Fails with out_of_range
  /// beyond the next seq that will be durable. Asked again, it starts anew from there.
  [[nodiscard]] protocol::Result<void> follow(ViewerId viewer, std::uint64_t from_seq);

  using Command = room::Command;
  /// Puts an edit or a change of layers in line. Fails when `check_stamps` does, with too_large
  /// when kMaxWaitingPoints would be exceeded, and with what the journal failed with just now; then
  /// it has no number. Otherwise the viewer is told later, never from within the call: its number,
  /// the one that it has already when the author's id was applied before, or that it has none, by
  /// id_out_of_order, id_too_old, `check_layers` or what the journal fails with. An author's come
  /// to their turn in the order of submission, whichever viewers they come from. A large one takes
  /// many tasks; meanwhile others are applied and numbered before it, unless they come near its
  /// place.
  [[nodiscard]] protocol::Result<void> submit(ViewerId viewer, Command command);

  /// Calls `then` on the strand when all that is applied now is durable: within the call when it is
  /// so already. With false when some of it was taken back, or the room has closed first.
  void once_durable(std::function<void(bool kept)> then);
  /// When nobody is inside, no edit waits and nothing is in flight: closes the room, which then
  /// refuses with `unavailable`, makes a last keyframe, lets go of the clerk, and then calls
  /// `closed`, on any thread, unless `close` comes first. False, and nothing happens, when it is in
  /// use or closed.
  [[nodiscard]] bool retire(std::function<void()> closed);
  /// Of the last join, leave, edit or question.
  [[nodiscard]] std::int64_t last_used_ms() const { return last_used_ms_; }
  /// Why nobody can join any more; nothing as long as it is open.
  [[nodiscard]] const std::optional<protocol::Failure>& closed() const { return closed_; }

  [[nodiscard]] RoomInfo info();
  [[nodiscard]] RoomLoad load() const;
  /// Brings up to `budget` chunks' meshes up to date with all that is applied; true when all are.
  /// Viewers come first: while they wait for a commit that meshes were brought past before, it is
  /// false and nothing is made. So whoever needs several calls waits with `once_durable` before
  /// each.
  [[nodiscard]] bool refresh_meshes(std::size_t budget);
  /// After `refresh_meshes` gave true in the same task. These three are of what is applied: they
  /// are told to nobody before `once_durable`, asked in the same task, says that it was kept.
  [[nodiscard]] RoomFigures figures();
  [[nodiscard]] MeshSnapshot meshes() const;
  [[nodiscard]] protocol::Result<StatesPicture> states(std::uint64_t layer);

  /// Says `bye` to all viewers and lets nobody in again. What is on its way into the journal gets
  /// there; what is not, does not.
  void close(const protocol::Bye& bye);

 private:
  void run(const std::function<void()>& task);
  void run_later(std::chrono::milliseconds delay, std::function<void()> task);
  [[nodiscard]] Workplace workplace();
  void schedule_turn();
  void turn();
  void schedule_slice();
  void slice();
  std::uint64_t accept(Command& command, const voxel::Change& change);
  void go_on();
  void hand_over();
  void committed();
  void settle();
  void take_back(const protocol::Failure& failure);
  void tell();
  void let_go();
  void used() { last_used_ms_ = strand_->now_ms(); }

  const std::string name_;
  SettingsBook settings_;
  const std::uint64_t epoch_;
  const std::shared_ptr<Strand> strand_;  // shared with what the clerk brings back
  const std::shared_ptr<Meters> meters_;
  const Commits commits_;
  std::unique_ptr<journal::Clerk> clerk_;

  voxel::Map map_;
  Ledger ledger_;
  Publisher publisher_;
  PastEvents events_;
  Herald herald_;
  Keyframer keyframer_;
  EditDesk desk_;
  Seats seats_;
  ViewerId last_viewer_ = 0;
  std::optional<RoomFigures> figures_;  // the last ones asked for
  std::int64_t last_used_ms_ = 0;
  bool turn_scheduled_ = false, slice_scheduled_ = false;
  std::optional<protocol::Failure> closed_;  // why
};

}  // namespace earthwork::room
