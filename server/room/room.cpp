#include "server/room/room.hpp"

#include <spdlog/spdlog.h>

#include <cassert>
#include <string>
#include <utility>

namespace earthwork::room {
namespace {

using protocol::Code;

// After a journal turned out to be another than it should be, its map is opened anew.
constexpr std::uint32_t kReopenMs = 1000;

/// Whether what could not be stored now may be stored later.
bool may_pass(Code code) {
  return code == Code::disk_full || code == Code::read_only || code == Code::storage_failed;
}

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

Room::Room(std::string name, Opening opening, std::unique_ptr<Strand> strand,
           std::shared_ptr<Meters> meters)
    : name_(std::move(name)),
      settings_(std::move(opening.restored.settings)),
      epoch_(opening.identity.epoch),
      strand_(std::move(strand)),
      meters_(std::move(meters)),
      commits_(opening.commits),
      clerk_(std::move(opening.clerk)),
      map_(std::move(opening.restored.map)),
      ledger_(*clerk_, {opening.restored.seq, opening.restored.hash, map_.chunk_count()}, meters_),
      publisher_(
          {map_, settings_.accepted(), epoch_, opening.restored.seq, opening.restored.ages,
           meters_},
          [this](std::chrono::milliseconds delay, std::function<void()> task) {
            run_later(delay, std::move(task));
          },
          [this] { return workplace(); }),
      events_(
          *clerk_, [this] { return workplace(); }, opening.restored.seq),
      herald_(events_, *strand_,
              opening.chat ? std::move(opening.chat) : std::make_shared<ChatLog>(),
              [this](std::chrono::milliseconds delay, std::function<void()> task) {
                run_later(delay, std::move(task));
              }),
      keyframer_({map_, settings_.accepted(),
                  [this](std::uint64_t author) { return desk_.authors().state(author); }, *clerk_,
                  [this] { return workplace(); }, *strand_, meters_},
                 opening.restored),
      desk_(
          {map_, settings_}, commits_, opening.restored.authors, opening.restored.seq, meters_,
          {.applied = [this](Command& command,
                             const voxel::Change& change) { return accept(command, change); },
           .answered = [this](ViewerId viewer, Reply reply,
                              std::uint64_t seq) { seats_.answer(viewer, std::move(reply), seq); },
           .full = [this] { return ledger_.full(); }}) {
  used();
}

Room::~Room() = default;

protocol::Result<Room::Entrance> Room::join(std::shared_ptr<Viewer> viewer, protocol::User user) {
  if (closed_) return tl::unexpected<protocol::Failure>(*closed_);
  used();
  const ViewerId id = ++last_viewer_;
  auto guarded = std::make_shared<GuardedViewer>(std::move(viewer), [this] { schedule_turn(); });
  publisher_.enter(id, *guarded);
  herald_.enter(id, *guarded, std::move(user));
  seats_.enter(id, std::move(guarded));

  protocol::Joined joined{.map = name_,
                          .settings = settings(),
                          .epoch = protocol::hex(epoch_),
                          .seq = ledger_.durable().seq,
                          .users = herald_.users_for(id),
                          .id = {}};
  return Entrance{id, std::move(joined)};
}

void Room::leave(ViewerId viewer) {
  used();
  publisher_.leave(viewer);
  herald_.leave(viewer);
  seats_.leave(viewer);
}

void Room::leave_when_told(ViewerId viewer, std::function<void()> gone) {
  if (seats_.leaves_when_told(viewer, gone)) {
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
  const auto known = settings_.durable();  // of a layer that nobody was told of nobody points
  if (cursor.at) {
    const protocol::Edit stamp = stamp_at(*cursor.at, cursor.brush.value_or(protocol::Brush{}));
    if (auto checked = protocol::check_edit(stamp, *known); !checked) return checked;
  }
  if (cursor.view) {
    if (auto checked = protocol::check_seen(*cursor.view, *known); !checked) return checked;
  }
  herald_.point(viewer, cursor);
  return {};
}

protocol::Result<void> Room::say(ViewerId viewer, std::string text) {
  if (!seats_.contains(viewer)) return protocol::fail(Code::bad_state, "chat: join a map first");
  used();
  herald_.say(viewer, std::move(text));
  ++meters_->chat_lines;
  return {};
}

protocol::Result<void> Room::follow(ViewerId viewer, std::uint64_t from_seq) {
  if (!seats_.contains(viewer)) return protocol::fail(Code::bad_state, "events: join a map first");
  const std::uint64_t next = events_.last_seq() + 1;
  if (from_seq < 1 || from_seq > next)
    return protocol::fail(Code::out_of_range,
                          "from_seq: " + std::to_string(from_seq) + " is not among 1 to " +
                              std::to_string(next) + ", the next event's",
                          "from_seq");
  herald_.follow(viewer, from_seq);
  return {};
}

protocol::Result<void> Room::submit(ViewerId viewer, Command command) {
  if (!seats_.contains(viewer)) return protocol::fail(Code::bad_state, "edit: join a map first");
  used();
  const auto* edit = std::get_if<protocol::Edit>(&command.action);
  if (edit)
    if (auto checked = protocol::check_stamps(*edit, settings_.accepted()); !checked)
      return checked;
  if (const protocol::Failure* trouble = ledger_.trouble(last_used_ms_))
    return tl::unexpected<protocol::Failure>(*trouble);
  const std::uint64_t cost = edit ? rows_visited(*edit, settings_.accepted()) : 1;
  if (!desk_.push({viewer, std::move(command), cost, last_used_ms_}))
    return protocol::fail(Code::too_large,
                          "path: edits of " + std::to_string(kMaxWaitingPoints) +
                              " points may wait in a map; send it again later",
                          "path");
  seats_.owe_answer(viewer);
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

// What comes back from another thread shares the strand, and holds the room on it only: the last
// to let go of a room must not be its own clerk.
Workplace Room::workplace() {
  return {.aside =
              [strand = strand_, weak = weak_from_this()](Strand::Task task) {
                if (!weak.expired()) strand->post_aside(std::move(task));
              },
          .back =
              [strand = strand_, weak = weak_from_this()](Strand::Task task) {
                strand->post([weak, task = std::move(task)] {
                  if (const auto self = weak.lock()) self->run(task);
                });
              }};
}

void Room::schedule_turn() {
  if (turn_scheduled_) return;
  turn_scheduled_ = true;
  strand_->post([self = shared_from_this()] { self->run([&] { self->turn(); }); });
}

void Room::turn() {
  turn_scheduled_ = false;
  desk_.take_turn();
  if (desk_.preparing()) schedule_slice();
  go_on();
}

void Room::schedule_slice() {
  if (slice_scheduled_) return;
  slice_scheduled_ = true;
  strand_->post([self = shared_from_this()] { self->run([&] { self->slice(); }); });
}

// One slice a task: turns, and whatever else the strand has to do, come in between.
void Room::slice() {
  slice_scheduled_ = false;
  if (!desk_.preparing()) return;  // closed, or taken back meanwhile
  desk_.prepare();
  if (desk_.preparing())
    schedule_slice();
  else
    schedule_turn();
}

std::uint64_t Room::accept(Command& command, const voxel::Change& change) {
  history::Event event{.seq = ledger_.accepted_seq() + 1,
                       .time_ms = strand_->now_ms(),
                       .author = command.author,
                       .id = command.id,
                       .action = std::move(command.action),
                       .hash = map_.hash()};
  publisher_.changed(change, event.seq);
  if (commits_ == Commits::later) keyframer_.accepted(event, change.changed);
  ledger_.accept(std::move(event));
  return ledger_.accepted_seq();
}

// After every turn, and after every commit: what has gathered goes on its way, and what is durable
// to those who wait for it.
void Room::go_on() {
  hand_over();
  if (closed_) return;
  tell();
  publisher_.durable(ledger_.durable().seq);
  publisher_.show();
  ledger_.tell_waiters();
  if (desk_.has_next() && !ledger_.full()) schedule_turn();
}

void Room::hand_over() {
  if (!ledger_.can_hand_over()) return;
  desk_.handed_over();
  if (commits_ == Commits::later) keyframer_.handed_over();
  const bool ended = ledger_.hand_over(
      map_.chunk_count(), [this, back = workplace().back] { back([this] { committed(); }); });
  if (ended) settle();
}

void Room::committed() {
  if (closed_) return;
  settle();
  if (!closed_) go_on();
}

void Room::settle() {
  const auto events = ledger_.settle(strand_->now_ms());
  if (!events) return take_back(events.error());
  desk_.durable(ledger_.durable().seq);
  if (const std::uint64_t seq = settings_.store(*events); seq > 0)
    seats_.tell_settings(std::make_shared<const std::string>(
        protocol::write(protocol::SettingsChanged{.seq = seq, .settings = settings()})));
  events_.add(*events);
  meters_->edits += events->size();
  if (commits_ == Commits::later) keyframer_.durable();
}

void Room::take_back(const protocol::Failure& failure) {
  // Not more often than the ledger tries.
  spdlog::error("map {}: edits could not be stored: {}: {}", name_, protocol::name(failure.code),
                failure.detail);
  if (commits_ == Commits::at_once || !may_pass(failure.code))
    return close({.failure = failure, .retry_after_ms = kReopenMs});
  seats_.refuse_answers(ledger_.durable().seq, failure);
  desk_.take_back(failure);
  assert(map_.hash() == ledger_.durable().hash);
  keyframer_.taken_back();
  publisher_.durable(ledger_.durable().seq);  // the batch before may have ended just now
  publisher_.taken_back();
  figures_.reset();
}

void Room::tell() {
  seats_.tell_answers(ledger_.durable().seq);
  let_go();
  herald_.tell_events();
}

void Room::let_go() {
  for (const Seats::Leaver& left : seats_.take_leavers()) {
    leave(left.id);
    if (left.gone) left.viewer->guard(left.gone);
  }
}

void Room::once_durable(std::function<void(bool)> then) {
  used();
  if (closed_) return then(false);
  ledger_.once_durable(std::move(then));
}

bool Room::retire(std::function<void()> closed) {
  if (closed_ || !seats_.empty() || !desk_.line().empty() || !ledger_.idle()) return false;
  closed_ = {Code::unavailable, "the map is put away", "map"};
  publisher_.leave_all();
  keyframer_.finish([self = shared_from_this(), closed = std::move(closed)] {
    // The end of a clerk may take a while.
    self->strand_->post_aside([clerk = std::shared_ptr(std::move(self->clerk_)), closed]() mutable {
      clerk.reset();
      closed();
    });
  });
  return true;
}

RoomInfo Room::info() {
  used();
  const auto [seq, hash, chunks] = ledger_.durable();
  return {
      .seq = seq, .hash = hash, .settings = settings(), .chunks = chunks, .users = seats_.size()};
}

bool Room::refresh_meshes(std::size_t budget) {
  used();
  return publisher_.refresh(budget);
}

RoomLoad Room::load() const {
  return {.waiting_edits = desk_.line().size(),
          .oldest_wait_ms = desk_.line().oldest_wait_ms(strand_->now_ms()),
          .owed_chunks = publisher_.owed_chunks(),
          .dirty_chunks = publisher_.dirty_chunks(),
          .viewers = seats_.size()};
}

RoomFigures Room::figures() {
  const std::uint64_t seq = ledger_.accepted_seq();
  if (!figures_ || figures_->seq != seq)
    figures_ =
        RoomFigures{.seq = seq,
                    .hash = map_.hash(),
                    .chunks = map_.chunk_count(),
                    .voxel_bytes = map_.memory_bytes(),
                    .geometry = mesh::count_figures(map_, settings_.accepted().max_feature_angle),
                    .meshes = publisher_.totals()};
  return *figures_;
}

MeshSnapshot Room::meshes() const {
  return {.seq = ledger_.accepted_seq(),
          .mesh_hash = publisher_.totals().hash,
          .settings = settings_.accepted(),
          .records = publisher_.records()};
}

protocol::Result<StatesPicture> Room::states(std::uint64_t layer) {
  used();
  return draw_states(map_, layer);
}

void Room::close(const protocol::Bye& bye) {
  closed_ = bye.failure;
  desk_.clear();
  publisher_.leave_all();
  herald_.leave_all();
  ledger_.give_up();
  keyframer_.give_up();
  seats_.end(bye);
}

}  // namespace earthwork::room
