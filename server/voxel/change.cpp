#include "server/voxel/change.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

namespace earthwork::voxel {
namespace {

/// The order in which chunks are visited: top row first, right to left in a row.
bool visited_before(const ChunkKey& a, const ChunkKey& b) {
  return a.y != b.y ? a.y > b.y : a.x > b.x;
}

bool dirtied_before(const DirtyChunk& a, const DirtyChunk& b) {
  return visited_before(a.key, b.key);
}

CellRect united(const CellRect& a, const CellRect& b) {
  return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

// Of lists in order: those of one chunk lie side by side.
void name_each_once(Change& change) {
  auto& changed = change.changed;
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  auto& dirty = change.dirty;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < dirty.size(); ++k) {
    if (kept > 0 && dirty[kept - 1].key == dirty[k].key) {
      dirty[kept - 1].cells = united(dirty[kept - 1].cells, dirty[k].cells);
    } else {
      dirty[kept++] = dirty[k];
    }
  }
  dirty.resize(kept);
}

template <class T, class Before>
void merge_in(std::vector<T>& all, const std::vector<T>& more, Before before) {
  std::vector<T> both;
  both.reserve(all.size() + more.size());
  std::merge(all.begin(), all.end(), more.begin(), more.end(), std::back_inserter(both), before);
  all = std::move(both);
}

}  // namespace

void put_in_order(Change& change) {
  std::sort(change.changed.begin(), change.changed.end(), visited_before);
  std::sort(change.dirty.begin(), change.dirty.end(), dirtied_before);
  name_each_once(change);
}

void add(Change& all, const Change& more) {
  merge_in(all.changed, more.changed, visited_before);
  merge_in(all.dirty, more.dirty, dirtied_before);
  name_each_once(all);
}

}  // namespace earthwork::voxel
