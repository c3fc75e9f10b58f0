#include "server/room/room.hpp"

#include <utility>

#include "server/history/fold.hpp"

namespace earthwork::room {
namespace {

using protocol::Code;

// A turn applies edits until one of these bounds, then shows them: so that a crowd of editors is
// meshed and sent for once, and that a flood of edits does not keep everybody waiting. Visits count
// whether or not a chunk changes: the largest edit has four times this many.
constexpr int kTurnEdits = 512;
constexpr std::size_t kTurnDirtyChunks = 1024;
constexpr std::uint64_t kTurnChunkVisits = 65536;

// `joined` lists this many; it stays far below kMaxServerControlBytes.
constexpr std::size_t kMaxListedUsers = 1000;

/// The chunks that an edit looks at, a chunk once a stamp, or a few more.
std::uint64_t chunk_visits(const protocol::Edit& edit, const protocol::MapSettings& settings) {
  const double side_voxels = 2 * edit.radius / settings.voxel_size;
  const auto side = static_cast<std::uint64_t>(side_voxels / settings.chunk_resolution) + 2;
  return side * side * edit.path.size();
}

}  // namespace

Room::Room(std::string name, protocol::MapSettings settings, std::uint64_t epoch,
           std::unique_ptr<Strand> strand, std::shared_ptr<Meters> meters)
    : name_(std::move(name)),
      settings_(std::move(settings)),
      epoch_(epoch),
      strand_(std::move(strand)),
      meters_(std::move(meters)),
      map_(history::make_map(settings_)),
      publisher_(map_, settings_, epoch_,
                 [this](std::chrono::milliseconds delay, std::function<void()> task) {
                   run_later(delay, std::move(task));
                 }) {}

protocol::Result<Room::Entrance> Room::join(std::shared_ptr<Viewer> viewer, protocol::User user) {
  if (closed_) return tl::unexpected<protocol::Failure>(*closed_);
  const ViewerId id = ++last_viewer_;
  Seat& seat = seats_[id];
  seat.viewer = std::move(viewer);
  seat.user = std::move(user);
  publisher_.enter(id, *seat.viewer);

  protocol::Joined joined{.map = name_,
                          .settings = settings_,
                          .epoch = protocol::hex(epoch_),
                          .seq = seq(),
                          .users = {},
                          .id = {}};
  for (const auto& [other, other_seat] : seats_) {
    if (joined.users.size() == kMaxListedUsers) break;
    joined.users.push_back(other_seat.user);
  }
  return Entrance{id, std::move(joined)};
}

void Room::leave(ViewerId viewer) {
  publisher_.leave(viewer);
  seats_.erase(viewer);
}

void Room::leave_when_told(ViewerId viewer, std::function<void()> gone) {
  const auto found = seats_.find(viewer);
  if (found != seats_.end() && found->second.waiting > 0) {
    found->second.gone = std::move(gone);
    publisher_.leave(viewer);
    return;
  }
  leave(viewer);
  gone();
}

protocol::Result<void> Room::look(ViewerId viewer, const protocol::View& view) {
  if (!seats_.contains(viewer)) return protocol::fail(Code::bad_state, "view: join a map first");
  return publisher_.look(viewer, view);
}

void Room::ready(ViewerId viewer) { publisher_.ready(viewer); }

void Room::heard(ViewerId) {}

protocol::Result<void> Room::point(ViewerId, const protocol::Cursor&) {
  return protocol::fail(Code::not_supported, "cursor is not offered by this server", "type");
}

protocol::Result<void> Room::follow(ViewerId, std::uint64_t) {
  return protocol::fail(Code::not_supported, "events is not offered by this server", "type");
}

protocol::Result<void> Room::submit(ViewerId viewer, Command command) {
  const auto found = seats_.find(viewer);
  if (found == seats_.end()) return protocol::fail(Code::bad_state, "edit: join a map first");
  if (auto checked = protocol::check_edit(command.edit, settings_); !checked) return checked;
  const std::size_t points = command.edit.path.size();
  if (waiting_points_ + points > kMaxWaitingPoints)
    return protocol::fail(Code::too_large,
                          "path: edits of " + std::to_string(kMaxWaitingPoints) +
                              " points may wait in a map; send it again later",
                          "path");
  waiting_.push_back({viewer, std::move(command)});
  waiting_points_ += points;
  ++found->second.waiting;
  schedule_turn();
  return {};
}

void Room::run(const std::function<void()>& task) {
  try {
    task();
  } catch (...) {
    close({.failure = {Code::internal, "map: it ended after a mistake of the server", "map"},
           .retry_after_ms = {}});
    throw;
  }
}

void Room::run_later(std::chrono::milliseconds delay, std::function<void()> task) {
  auto guarded = [weak = weak_from_this(), task = std::move(task)] {
    if (const auto self = weak.lock()) self->run(task);
  };
  if (delay.count() == 0)
    strand_->post(std::move(guarded));
  else
    strand_->post_after(delay, std::move(guarded));
}

void Room::schedule_turn() {
  if (turn_scheduled_) return;
  turn_scheduled_ = true;
  strand_->post([self = shared_from_this()] { self->run([&] { self->turn(); }); });
}

void Room::turn() {
  turn_scheduled_ = false;
  std::size_t dirty_chunks = 0;
  std::uint64_t visits = 0;
  for (int n = 0; n < kTurnEdits && dirty_chunks < kTurnDirtyChunks && visits < kTurnChunkVisits &&
                  !waiting_.empty();
       ++n) {
    visits += chunk_visits(waiting_.front().command.edit, settings_);
    dirty_chunks += apply_next();
  }
  acknowledge();
  let_go();
  publisher_.show(seq());
  if (!waiting_.empty()) schedule_turn();
}

/// Gives back how many chunks are to be meshed again.
std::size_t Room::apply_next() {
  Waiting next = std::move(waiting_.front());
  waiting_.pop_front();
  waiting_points_ -= next.command.edit.path.size();

  const voxel::Change& change = history::apply(map_, next.command.edit);
  ++meters_->edits;
  publisher_.changed(change);
  const std::size_t dirty_chunks = change.dirty.size();

  events_.push_back({.seq = seq() + 1,
                     .time_ms = strand_->now_ms(),
                     .author = next.command.author,
                     .edit = std::move(next.command.edit)});
  if (const auto seat = seats_.find(next.viewer); seat != seats_.end()) {
    --seat->second.waiting;
    seat->second.told.push_back(protocol::Applied{.id = next.command.id, .seq = seq()});
  }
  return dirty_chunks;
}

void Room::acknowledge() {
  for (auto& [id, seat] : seats_)
    if (!seat.told.empty()) seat.viewer->answered(std::exchange(seat.told, {}));
}

void Room::let_go() {
  for (auto seat = seats_.begin(); seat != seats_.end();) {
    if (!seat->second.gone || seat->second.waiting > 0) {
      ++seat;
      continue;
    }
    const auto gone = std::move(seat->second.gone);
    seat = seats_.erase(seat);
    gone();
  }
}

RoomInfo Room::info() {
  return {.seq = seq(), .hash = map_.hash(), .chunks = map_.chunk_count(), .users = seats_.size()};
}

RoomFigures Room::figures() {
  if (!figures_ || figures_->seq != seq())
    figures_ = RoomFigures{.seq = seq(),
                           .hash = map_.hash(),
                           .chunks = map_.chunk_count(),
                           .voxel_bytes = map_.memory_bytes(),
                           .geometry = mesh::count_figures(map_, settings_.max_feature_angle),
                           .meshes = publisher_.totals()};
  return *figures_;
}

MeshSnapshot Room::meshes() const {
  return {.seq = seq(), .mesh_hash = publisher_.totals().hash, .records = publisher_.records()};
}

protocol::Result<StatesPicture> Room::states(std::uint64_t layer) const {
  return draw_states(map_, layer);
}

void Room::close(const protocol::Bye& bye) {
  closed_ = bye.failure;
  waiting_.clear();
  waiting_points_ = 0;
  publisher_.leave_all();
  for (auto& [id, seat] : std::exchange(seats_, {})) seat.viewer->end(bye);
}

}  // namespace earthwork::room
