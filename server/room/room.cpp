#include "server/room/room.hpp"

#include <string>
#include <utility>

#include "server/history/fold.hpp"

namespace earthwork::room {
namespace {

using protocol::Code;

// A turn applies edits until one of these bounds, then shows them: so that a crowd of editors is
// meshed and sent for once, and that a flood of edits does not keep everybody waiting. Rows count
// whether or not they change. An edit of very many is not applied in a turn but prepared between
// turns.
constexpr int kTurnEdits = 512;
constexpr std::size_t kTurnDirtyChunks = 1024;
constexpr std::uint64_t kTurnRows = 262'144;

/// The stamp that a click at the cursor would be.
protocol::Edit stamp_at(const protocol::MapPoint& at, const protocol::Brush& brush) {
  return {.layer = brush.layer,
          .stencil = brush.stencil,
          .fill = brush.fill,
          .radius = brush.radius,
          .path = {at},
          .stroke = {}};
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
      publisher_(
          {map_, settings_, epoch_, meters_},
          [this](std::chrono::milliseconds delay, std::function<void()> task) {
            run_later(delay, std::move(task));
          },
          [this] { return workplace(); }),
      herald_(events_, *strand_,
              [this](std::chrono::milliseconds delay, std::function<void()> task) {
                run_later(delay, std::move(task));
              }),
      slicer_(map_) {}

protocol::Result<Room::Entrance> Room::join(std::shared_ptr<Viewer> viewer, protocol::User user) {
  if (closed_) return tl::unexpected<protocol::Failure>(*closed_);
  const ViewerId id = ++last_viewer_;
  auto guarded = std::make_shared<GuardedViewer>(std::move(viewer), [this] { schedule_turn(); });
  publisher_.enter(id, *guarded);
  herald_.enter(id, *guarded, std::move(user));
  seats_[id].viewer = std::move(guarded);

  protocol::Joined joined{.map = name_,
                          .settings = settings_,
                          .epoch = protocol::hex(epoch_),
                          .seq = seq(),
                          .users = herald_.users_for(id),
                          .id = {}};
  return Entrance{id, std::move(joined)};
}

void Room::leave(ViewerId viewer) {
  publisher_.leave(viewer);
  herald_.leave(viewer);
  seats_.erase(viewer);
}

void Room::leave_when_told(ViewerId viewer, std::function<void()> gone) {
  const auto found = seats_.find(viewer);
  if (found != seats_.end() && found->second.waiting > 0) {
    found->second.gone = std::move(gone);
    publisher_.leave(viewer);
    herald_.leave(viewer);
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

void Room::heard(ViewerId viewer) { herald_.heard(viewer); }

protocol::Result<void> Room::point(ViewerId viewer, const protocol::Cursor& cursor) {
  if (!seats_.contains(viewer)) return protocol::fail(Code::bad_state, "cursor: join a map first");
  if (cursor.at) {
    const protocol::Edit stamp = stamp_at(*cursor.at, cursor.brush.value_or(protocol::Brush{}));
    if (auto checked = protocol::check_edit(stamp, settings_); !checked) return checked;
  }
  herald_.point(viewer, cursor);
  return {};
}

protocol::Result<void> Room::follow(ViewerId viewer, std::uint64_t from_seq) {
  if (!seats_.contains(viewer)) return protocol::fail(Code::bad_state, "events: join a map first");
  if (from_seq < 1 || from_seq > seq() + 1)
    return protocol::fail(Code::out_of_range,
                          "from_seq: " + std::to_string(from_seq) + " is not among 1 to " +
                              std::to_string(seq() + 1) + ", the next event's",
                          "from_seq");
  herald_.follow(viewer, from_seq);
  return {};
}

protocol::Result<void> Room::submit(ViewerId viewer, Command command) {
  const auto found = seats_.find(viewer);
  if (found == seats_.end()) return protocol::fail(Code::bad_state, "edit: join a map first");
  if (auto checked = protocol::check_edit(command.edit, settings_); !checked) return checked;
  const std::uint64_t cost = rows_visited(command.edit, settings_);
  if (!line_.push({viewer, std::move(command), cost, strand_->now_ms()}))
    return protocol::fail(Code::too_large,
                          "path: edits of " + std::to_string(kMaxWaitingPoints) +
                              " points may wait in a map; send it again later",
                          "path");
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

Workplace Room::workplace() {
  const auto weak = weak_from_this();
  return {.aside =
              [weak](Strand::Task task) {
                if (const auto self = weak.lock()) self->strand_->post_aside(std::move(task));
              },
          .back =
              [weak](Strand::Task task) {
                if (const auto self = weak.lock())
                  self->strand_->post([self, task = std::move(task)] { self->run(task); });
              }};
}

void Room::schedule_turn() {
  if (turn_scheduled_) return;
  turn_scheduled_ = true;
  strand_->post([self = shared_from_this()] { self->run([&] { self->turn(); }); });
}

void Room::turn() {
  turn_scheduled_ = false;
  turn_chunks_ = 0, turn_rows_ = 0;
  if (slicer_.through()) commit_sliced();
  for (int n = 0; n < kTurnEdits && turn_chunks_ < kTurnDirtyChunks && turn_rows_ < kTurnRows &&
                  line_.has_next();
       ++n)
    take_next();
  acknowledge();
  let_go();
  herald_.tell_events();
  publisher_.show(seq());
  if (line_.has_next()) schedule_turn();
}

// What cannot be applied now keeps its place in line, and its author's later ones wait behind it.
// So whatever was fresh when its preparation began is fresh at its end.
void Room::take_next() {
  const Line::Waiting& next = line_.next();
  if (slicer_.must_wait(next)) return line_.put_aside();
  const auto fresh = [&] {
    return authors_.judge(next.command.author, next.command.id).standing ==
           Authors::Standing::fresh;
  };
  if (Slicer::too_large(next) && fresh()) {
    slicer_.start(next.command);
    line_.put_aside();
    return schedule_slice();
  }
  Line::Waiting taken = line_.pop();
  turn_rows_ += taken.cost;
  answer(taken.viewer, decide(taken.command));
}

void Room::schedule_slice() {
  strand_->post([self = shared_from_this()] { self->run([&] { self->slice(); }); });
}

// One slice a task: turns, and whatever else the strand has to do, come in between.
void Room::slice() {
  if (!slicer_.busy()) return;  // closed meanwhile
  slicer_.advance();
  if (slicer_.through())
    schedule_turn();
  else
    schedule_slice();
}

void Room::commit_sliced() {
  Line::Waiting done = line_.take(slicer_.author());
  line_.recall();
  accept(done.command, slicer_.commit());
  answer(done.viewer, protocol::Applied{.id = done.command.id, .seq = seq()});
}

void Room::answer(ViewerId viewer, Reply reply) {
  const auto seat = seats_.find(viewer);
  if (seat == seats_.end()) return;
  --seat->second.waiting;
  seat->second.told.push_back(std::move(reply));
}

Reply Room::decide(Command& command) {
  const auto refuse = [&](Code code, const std::string& why) {
    return protocol::Rejected{
        .id = command.id,
        .failure = {code, "id: " + std::to_string(command.id) + why, "id"},
    };
  };
  const auto [standing, seq_before] = authors_.judge(command.author, command.id);
  switch (standing) {
    case Authors::Standing::fresh:
      accept(command, history::apply(map_, command.edit));
      return protocol::Applied{.id = command.id, .seq = seq()};
    case Authors::Standing::repeated:
      ++meters_->repeated;
      return protocol::Applied{.id = command.id, .seq = seq_before};
    case Authors::Standing::out_of_order:
      return refuse(Code::id_out_of_order, " was not applied, and a larger one was");
    case Authors::Standing::too_old:
      break;
  }
  return refuse(Code::id_too_old, " is below the last " +
                                      std::to_string(protocol::kMaxRememberedIds) +
                                      ", which are all that are remembered");
}

// The map has the edit, and nothing after it.
void Room::accept(Command& command, const voxel::Change& change) {
  publisher_.changed(change);
  turn_chunks_ += change.dirty.size();
  events_.push_back({.seq = seq() + 1,
                     .time_ms = strand_->now_ms(),
                     .author = command.author,
                     .id = command.id,
                     .edit = std::move(command.edit),
                     .hash = map_.hash()});
  authors_.applied(command.author, command.id, seq());
  ++meters_->edits;
}

void Room::acknowledge() {
  for (auto& [id, seat] : seats_)
    if (!seat.told.empty()) seat.viewer->answered(std::exchange(seat.told, {}));
}

void Room::let_go() {
  for (auto seat = seats_.begin(); seat != seats_.end();) {
    const ViewerId id = seat->first;
    const bool leaves = seat->second.gone && seat->second.waiting == 0;
    if (!leaves && !seat->second.viewer->broken()) {
      ++seat;
      continue;
    }
    const Seat left = std::move(seat->second);
    ++seat;
    leave(id);
    if (left.gone) left.viewer->guard(left.gone);
  }
}

RoomInfo Room::info() {
  return {.seq = seq(), .hash = map_.hash(), .chunks = map_.chunk_count(), .users = seats_.size()};
}

RoomLoad Room::load() const {
  return {.waiting_edits = line_.size(),
          .oldest_wait_ms = line_.oldest_wait_ms(strand_->now_ms()),
          .owed_chunks = publisher_.owed_chunks(),
          .dirty_chunks = publisher_.dirty_chunks(),
          .viewers = seats_.size()};
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
  line_.clear();
  slicer_.clear();
  publisher_.leave_all();
  herald_.leave_all();
  for (auto& [id, seat] : std::exchange(seats_, {})) seat.viewer->end(bye);
}

}  // namespace earthwork::room
