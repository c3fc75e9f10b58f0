#include "server/room/mesh_round.hpp"

#include <algorithm>
#include <utility>

#include "server/room/meshing_time.hpp"

namespace earthwork::room {
namespace {

// About a millisecond of chunks as they are mostly, four of the fullest ones.
constexpr std::size_t kSliceChunks = 8;

}  // namespace

MeshRound::MeshRound(const voxel::Map& map, const MeshCache& cache,
                     std::span<const voxel::ChunkKey> keys, std::uint64_t seq)
    : count_(keys.size()), left_(keys.size()) {
  items_.reserve(keys.size());
  for (const voxel::ChunkKey& key : keys)
    items_.push_back({.key = key,
                      .chunks = voxel::KeptNeighbourhood(map, key),
                      .before = cache.forerunner(key, seq),
                      .made = {}});
}

void MeshRound::start(Workplace place, Makers makers, std::shared_ptr<Meters> meters,
                      std::function<void()> done) {
  place_ = std::move(place);
  makers_ = std::move(makers);
  meters_ = std::move(meters);
  done_ = std::move(done);
  const std::size_t slices = (count_ + kSliceChunks - 1) / kSliceChunks;
  for (std::size_t lane = 0; lane < std::min(slices, makers_.size()); ++lane)
    place_.aside([self = shared_from_this(), lane] { self->run_slice(lane); });
}

// Once its last items are counted off, a lane touches neither items nor makers: the strand may have
// taken them then.
void MeshRound::run_slice(std::size_t lane) {
  const std::span<Item> items = take(kSliceChunks);
  if (items.empty()) return;
  if (make(items, *makers_[lane]))
    place_.back([self = shared_from_this()] { self->done_(); });
  else
    place_.aside([self = shared_from_this(), lane] { self->run_slice(lane); });
}

std::span<MeshRound::Item> MeshRound::take(std::size_t most) {
  const std::size_t first = std::min(taken_.fetch_add(most), count_);
  const std::size_t taken = std::min(most, count_ - first);
  return taken == 0 ? std::span<Item>{} : std::span(items_).subspan(first, taken);
}

/// True for the one who made the last.
bool MeshRound::make(std::span<Item> items, MeshMaker& maker) {
  try {
    const MeshingTime time(*meters_, items.size());
    for (Item& item : items)
      item.made = maker.make(item.key, item.chunks.view(), item.chunks.resolution(), item.before);
  } catch (...) {
    if (!failed_.test_and_set()) failure_ = std::current_exception();
  }
  if (left_.fetch_sub(items.size()) != items.size()) return false;
  left_.notify_all();
  return true;
}

bool MeshRound::help(MeshMaker& maker, std::size_t& budget) {
  while (budget > 0 && taken_ < count_) {
    const std::span<Item> items = take(std::min(budget, kSliceChunks));
    if (items.empty()) break;
    budget -= items.size();
    make(items, maker);
  }
  if (taken_ < count_) return false;
  for (std::size_t left = left_; left > 0; left = left_) left_.wait(left);
  return true;
}

MeshRound::Makers MeshRound::finish(MeshCache& cache) {
  if (failure_) std::rethrow_exception(failure_);
  for (Item& item : std::exchange(items_, {})) cache.put(item.key, std::move(item.made));
  return std::move(makers_);
}

}  // namespace earthwork::room
