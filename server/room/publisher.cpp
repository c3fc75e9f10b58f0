#include "server/room/publisher.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "protocol/limits.hpp"
#include "server/room/meshing_time.hpp"

namespace earthwork::room {
namespace {

// A group without a chunk says how far the map is: at most 10 a second.
constexpr std::chrono::milliseconds kBeat{100};

// Up to so many meshes are made on the strand: they take no longer than to hand them to the pool
// and back would.
constexpr std::size_t kMadeHere = 8;

}  // namespace

Publisher::Publisher(Subject subject, Later later, std::function<Workplace()> workplace)
    : map_(subject.map),
      settings_(subject.settings),
      epoch_(subject.epoch),
      meters_(std::move(subject.meters)),
      later_(std::move(later)),
      workplace_(std::move(workplace)),
      seq_(subject.seq),
      latest_(subject.seq),
      durable_(subject.seq),
      maker_(settings_.max_feature_angle) {
  meshes_.restore(map_, subject.ages);
}

void Publisher::enter(ViewerId id, Viewer& viewer) { shows_[id].viewer = &viewer; }

void Publisher::leave(ViewerId id) { shows_.erase(id); }

protocol::Result<void> Publisher::look(ViewerId id, const protocol::View& view) {
  if (auto checked = protocol::check_view(view, settings_); !checked) return checked;
  const std::size_t chunks = view.rect ? 0 : chunks_to_show();
  if (chunks > protocol::kMaxViewChunks)
    return protocol::fail(protocol::Code::too_large,
                          "all: the map has " + std::to_string(chunks) +
                              " chunks, beyond a view's limit of " +
                              std::to_string(protocol::kMaxViewChunks),
                          "all");
  if (const auto found = shows_.find(id); found != shows_.end()) {
    std::optional<protocol::View>& wanted = found->second.wanted;
    if (!wanted) lookers_.push_back(id);
    wanted = wanted ? then_looks(*wanted, view) : view;
    publish_soon();
  }
  return {};
}

std::size_t Publisher::chunks_to_show() const {
  const auto others = std::count_if(pending_.begin(), pending_.end(), [this](const auto& key) {
    return !meshes_.may_have_mesh(key);
  });
  return meshes_.count() + static_cast<std::size_t>(others);
}

/// Gives back how many chunks are to be loaded for it.
std::size_t Publisher::take_up_a_view() {
  if (lookers_.empty()) return 0;
  const auto found = shows_.find(lookers_.front());
  lookers_.pop_front();
  if (found == shows_.end()) return 0;
  const protocol::View view = *std::exchange(found->second.wanted, std::nullopt);
  found->second.subscription.look(view, settings_, state());
  return found->second.subscription.owed_chunks();
}

// Only while what is shown is durable: what a viewer is held to know is never taken back. As much
// at a time as the largest view takes.
void Publisher::take_up_views() {
  if (lookers_.empty()) return;
  for (std::size_t chunks = 0; !lookers_.empty() && chunks < protocol::kMaxViewChunks; ++chunks)
    chunks += take_up_a_view();
  publish_soon();
}

void Publisher::ready(ViewerId id) {
  const auto found = shows_.find(id);
  if (found == shows_.end()) return;
  Show& show = found->second;
  show.ready = true;
  if (!held()) {
    RoundPlan plan(meshes_);
    show.subscription.plan_owed(plan);
    show.subscription.plan_first_load(plan);
    make(plan.keys());
  }
  publish_to(show, Beat::wait);
}

void Publisher::changed(const voxel::Change& change, std::uint64_t seq) {
  latest_ = seq;
  for (const voxel::DirtyChunk& chunk : change.dirty) pending_.insert(chunk.key);
}

void Publisher::durable(std::uint64_t seq) {
  const bool waited = !shown_is_durable();
  durable_ = seq;
  if (!waited || !shown_is_durable()) return;
  before_.clear();
  overtaken_ = false;
  take_up_views();
  publish(std::exchange(beat_waits_, false) ? Beat::due : Beat::wait);
}

void Publisher::show() {
  if (round_ || resting_ || latest_ == seq_ || !shown_is_durable()) return;
  rest();
  go_on();
}

// Viewers keep what they are owed for what is gone: that is more than they need, and when it is
// made again it is what they have.
void Publisher::taken_back() {
  latest_ = durable_;
  if (!shown_is_durable()) {
    round_.reset();
    for (auto& [key, before] : std::exchange(before_, {})) {
      meshes_.take_back(key, std::move(before));
      pending_.insert(key);
    }
    seq_ = delivered_;
    overtaken_ = false;
  }
  if (latest_ == seq_) pending_.clear();
  publish_soon();
}

void Publisher::rest() {
  const std::chrono::microseconds asked = kRestPerViewer * shows_.size();
  const auto time =
      std::min(std::chrono::duration_cast<std::chrono::milliseconds>(asked), kLongestRest);
  if (time.count() == 0) return;
  resting_ = true;
  later_(time, [this] {
    resting_ = false;
    show();
  });
}

// Not while a round runs: until it is over, meshes_ and what viewers are owed stay as of its seq.
void Publisher::go_on() {
  take_in_pending();
  make(plan_for_all().keys());
  publish(Beat::wait);
}

void Publisher::take_in_pending() {
  if (shown_is_durable()) delivered_ = seq_;
  seq_ = latest_;
  if (pending_.empty()) return;
  const std::vector<voxel::ChunkKey> dirty(pending_.begin(), pending_.end());
  pending_.clear();
  remember(dirty);
  meshes_.mark_stale(dirty);
  for (auto& [id, show] : shows_) show.subscription.owe(dirty);
}

// Who was just sent what is durable will be ready when the next commit ends: its meshes are made
// while that is under way, or the map would be further by then.
bool Publisher::plans_for(const Show& show) const {
  return show.ready || (!shown_is_durable() && show.sent_seq == delivered_);
}

RoundPlan Publisher::plan_for_all() {
  RoundPlan plan(meshes_);
  for (const auto& [id, show] : shows_)
    if (plans_for(show)) show.subscription.plan_owed(plan);
  // First loads take turns, because one round may not have room for all.
  auto next = shows_.upper_bound(last_loader_);
  for (std::size_t left = shows_.size(); left > 0 && plan.takes_first_seen(); --left, ++next) {
    if (next == shows_.end()) next = shows_.begin();
    if (plans_for(next->second)) next->second.subscription.plan_first_load(plan);
    last_loader_ = next->first;
  }
  return plan;
}

/// What these chunks have is about to be replaced, maybe by what will be taken back.
void Publisher::remember(std::span<const voxel::ChunkKey> keys) {
  if (shown_is_durable()) return;
  for (const voxel::ChunkKey& key : keys)
    if (!before_.contains(key)) before_.emplace(key, meshes_.forerunner(key, seq_));
}

void Publisher::make(const std::vector<voxel::ChunkKey>& keys) {
  if (keys.size() > kMadeHere)
    start_round(keys);
  else if (!keys.empty())
    make_here(keys);
}

void Publisher::make_here(std::span<const voxel::ChunkKey> keys) {
  remember(keys);
  const MeshingTime time(*meters_, keys.size());
  for (const voxel::ChunkKey& key : keys)
    meshes_.put(key, maker_.make(key, map_.neighbourhood(key), map_.grid().resolution,
                                 meshes_.forerunner(key, seq_)));
}

void Publisher::start_round(std::span<const voxel::ChunkKey> keys) {
  remember(keys);
  while (makers_.size() < kSlicesAtOnce)
    makers_.push_back(std::make_unique<MeshMaker>(settings_.max_feature_angle));
  round_ = std::make_shared<MeshRound>(map_, meshes_, keys, seq_);
  round_->start(workplace_(), std::exchange(makers_, {}), meters_, [this, started = round_.get()] {
    if (round_.get() != started) return;  // `refresh` has ended it
    end_round();
    if (latest_ != seq_)
      show();
    else
      go_on();
  });
}

// What was made is shown before anything newer is taken in: so every round brings everybody in it
// further, however fast edits come.
void Publisher::end_round() {
  makers_ = std::exchange(round_, nullptr)->finish(meshes_);
  publish(Beat::wait);
}

// What is shown may be gone on over while it is not durable, but not twice in a row: however many
// ask without end while edits come without end, at least every second commit shows something.
bool Publisher::refresh(std::size_t budget) {
  if (round_) {
    if (!round_->help(maker_, budget)) return false;
    end_round();
  }
  if (latest_ != seq_) {
    if (overtaken_) return false;
    overtaken_ = !shown_is_durable();
    publish_soon();  // also what changed no mesh has a number to tell
  }
  take_in_pending();
  if (meshes_.stale_count() > 0) {
    make_here(meshes_.some_stale(budget));
    publish_soon();
  }
  return meshes_.stale_count() == 0;
}

void Publisher::publish(Beat beat) {
  for (auto& [id, show] : shows_) publish_to(show, beat);
}

void Publisher::publish_to(Show& show, Beat beat) {
  if (!show.ready || !shown_is_durable()) return;
  const bool due = beat == Beat::due && show.subscription.behind(seq_);
  if (due || show.subscription.waiting()) {
    if (Parcel parcel = show.subscription.compose(state(), beat); !parcel.empty()) {
      show.ready = false;
      show.sent_seq = seq_;
      show.viewer->deliver(std::move(parcel));
    } else if (show.subscription.waiting() && !held()) {
      publish_soon();  // a stretch of a first load that held nothing
    }
  }
  if (show.ready && show.subscription.behind(seq_)) schedule_beat();
}

void Publisher::publish_soon() {
  if (publish_scheduled_) return;
  publish_scheduled_ = true;
  later_(std::chrono::milliseconds{0}, [this] {
    publish_scheduled_ = false;
    if (shown_is_durable()) {
      take_up_a_view();
      if (!lookers_.empty()) publish_soon();
    }
    if (held())
      publish(Beat::wait);
    else
      go_on();
  });
}

void Publisher::schedule_beat() {
  if (beat_scheduled_) return;
  beat_scheduled_ = true;
  later_(kBeat, [this] {
    beat_scheduled_ = false;
    beat_waits_ = !shown_is_durable();
    publish(Beat::due);
  });
}

std::size_t Publisher::owed_chunks() const {
  std::size_t sum = 0;
  for (const auto& [id, show] : shows_) sum += show.subscription.owed_chunks();
  return sum;
}

}  // namespace earthwork::room
