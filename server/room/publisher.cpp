#include "server/room/publisher.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "protocol/limits.hpp"

namespace earthwork::room {
namespace {

// A group without a chunk says how far the map is: at most 10 a second.
constexpr std::chrono::milliseconds kBeat{100};

}  // namespace

Publisher::Publisher(const voxel::Map& map, const protocol::MapSettings& settings,
                     std::uint64_t epoch, Later later)
    : map_(map),
      settings_(settings),
      epoch_(epoch),
      later_(std::move(later)),
      meshes_(settings.max_feature_angle) {}

void Publisher::enter(ViewerId id, Viewer& viewer) { shows_[id].viewer = &viewer; }

void Publisher::leave(ViewerId id) { shows_.erase(id); }

protocol::Result<void> Publisher::look(ViewerId id, const protocol::View& view) {
  if (auto checked = protocol::check_view(view, settings_); !checked) return checked;
  if (!view.rect && meshes_.count() > protocol::kMaxViewChunks)
    return protocol::fail(protocol::Code::too_large,
                          "all: the map has " + std::to_string(meshes_.count()) +
                              " chunks, beyond a view's limit of " +
                              std::to_string(protocol::kMaxViewChunks),
                          "all");
  if (const auto found = shows_.find(id); found != shows_.end()) {
    found->second.subscription.look(view, settings_, state());
    publish_soon();
  }
  return {};
}

void Publisher::ready(ViewerId id) {
  const auto found = shows_.find(id);
  if (found == shows_.end()) return;
  found->second.ready = true;
  publish_to(found->second, Beat::wait);
}

void Publisher::changed(const voxel::Change& change) {
  meshes_.mark_stale(change);
  for (const voxel::DirtyChunk& chunk : change.dirty) dirty_.push_back(chunk.key);
}

void Publisher::show(std::uint64_t seq) {
  seq_ = seq;
  std::sort(dirty_.begin(), dirty_.end());
  dirty_.erase(std::unique(dirty_.begin(), dirty_.end()), dirty_.end());
  for (auto& [id, show] : shows_) show.subscription.owe(dirty_);
  dirty_.clear();
  publish(Beat::wait);
}

void Publisher::publish(Beat beat) {
  for (auto& [id, show] : shows_) publish_to(show, beat);
}

void Publisher::publish_to(Show& show, Beat beat) {
  if (!show.ready) return;
  const bool due = beat == Beat::due && show.subscription.behind(seq_);
  if (due || show.subscription.waiting()) {
    if (Parcel parcel = show.subscription.compose(state(), beat); !parcel.empty()) {
      show.ready = false;
      show.viewer->deliver(std::move(parcel));
    } else if (show.subscription.waiting()) {
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
    publish(Beat::wait);
  });
}

void Publisher::schedule_beat() {
  if (beat_scheduled_) return;
  beat_scheduled_ = true;
  later_(kBeat, [this] {
    beat_scheduled_ = false;
    publish(Beat::due);
  });
}

std::size_t Publisher::owed_chunks() const {
  std::size_t sum = 0;
  for (const auto& [id, show] : shows_) sum += show.subscription.owed_chunks();
  return sum;
}

}  // namespace earthwork::room
