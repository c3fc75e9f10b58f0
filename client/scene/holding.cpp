#include "client/scene/holding.hpp"

#include <algorithm>

#include "protocol/json_text.hpp"

namespace earthwork::scene {

using protocol::ChunkRange;
using protocol::MapRect;

namespace {

/// A rectangle that meets the cells of these chunks and of no others: a quarter of a voxel inside
/// their border, which is half a voxel to the upper right of the voxels' squares.
MapRect rect_of(const ChunkRange& range, const protocol::MapSettings& settings) {
  const double side = settings.chunk_resolution;
  const auto from = [&](std::int32_t chunk) { return (chunk * side + 0.75) * settings.voxel_size; };
  const auto to = [&](std::int32_t chunk) { return (chunk * side + 0.25) * settings.voxel_size; };
  return {from(range.x0), from(range.y0), to(range.x1), to(range.y1)};
}

}  // namespace

void Holding::join(std::uint64_t epoch, std::uint64_t map_seq) {
  if (epoch != epoch_ || map_seq < seq_) {
    held_ = {};
    seq_ = 0;
  }
  epoch_ = epoch;
  live_ = false;
}

void Holding::look(std::uint32_t n, const std::optional<MapRect>& rect,
                   const protocol::MapSettings& settings) {
  view_ = n;
  settings_ = settings;
  wanted_ = rect ? protocol::chunks_of_cells(*rect, settings) : protocol::map_extent(settings);
  held_ = protocol::intersection(held_, *wanted_);
}

void Holding::catch_up(std::uint32_t n, std::uint64_t seq) {
  if (!wanted_ || n != view_) return;
  held_ = *wanted_;
  live_ = true;
  reach(seq);
}

void Holding::reach(std::uint64_t seq) {
  if (live_) seq_ = std::max(seq_, seq);
}

bool Holding::wants(const protocol::ChunkKey& key) const {
  return !wanted_ || wanted_->contains(key.x, key.y);
}

std::optional<protocol::Have> Holding::have() const {
  if (held_.empty() || seq_ == 0) return std::nullopt;
  return protocol::Have{
      .epoch = protocol::hex(epoch_), .seq = seq_, .rect = rect_of(held_, settings_)};
}

}  // namespace earthwork::scene
