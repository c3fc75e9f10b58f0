#include "server/voxel/chunk_edit.hpp"

#include <algorithm>
#include <bit>
#include <cassert>

namespace earthwork::voxel {
namespace {

/// The bits of `run` in the 64 columns from `base`.
std::uint64_t bits_from(Run run, std::int32_t base) {
  const std::int32_t first = std::max(run.first - base, 0), last = std::min(run.last - base, 63);
  if (first > last) return 0;
  return (~std::uint64_t{0} >> (63 - last)) & (~std::uint64_t{0} << first);
}

bool covers(Run run, std::int32_t column) { return run.first <= column && column <= run.last; }

std::uint64_t bit(bool value, int at) { return std::uint64_t{value} << at; }

/// The rectangle of cells around a set of changed voxels and edges.
class CellBounds {
 public:
  void add(std::uint64_t columns, int y) {
    if (columns == 0) return;
    columns_ |= columns;
    first_ = std::min(first_, y), last_ = std::max(last_, y);
  }
  CellRect rect() const {
    if (columns_ == 0) return {};
    return {std::countr_zero(columns_), first_, 64 - std::countl_zero(columns_), last_ + 1};
  }

 private:
  std::uint64_t columns_ = 0;
  int first_ = kMaxResolution, last_ = -1;
};

}  // namespace

/// Collects, row by row, the cells that a change reaches. A voxel belongs to four cells, an edge
/// to the two beside it.
class ChunkEdit::Tally {
 public:
  explicit Tally(int resolution) : resolution_(resolution) {}

  void add(int y, std::uint64_t states, std::uint64_t x_edges, std::uint64_t y_edges) {
    touched_.chunk |= (states | x_edges | y_edges) != 0;
    add_cells(y, states | y_edges, x_edges);
    add_cells(y - 1, states, x_edges);
  }
  Touched result() {
    touched_.own = own_.rect(), touched_.left = left_.rect();
    touched_.lower = lower_.rect(), touched_.lower_left = lower_left_.rect();
    return touched_;
  }

 private:
  // `both` reach the cells on both sides of their column, `right` only those to the right.
  void add_cells(int y, std::uint64_t both, std::uint64_t right) {
    const bool below = y < 0;
    const int row = below ? resolution_ - 1 : y;
    (below ? lower_ : own_).add(both | both >> 1 | right, row);
    (below ? lower_left_ : left_).add(bit((both & 1) != 0, resolution_ - 1), row);
  }

  int resolution_;
  Touched touched_;
  CellBounds own_, left_, lower_, lower_left_;
};

Touched ChunkEdit::apply(const Coverage& coverage, const ChunkPlace& place, Chunk& chunk) {
  const int resolution = chunk.resolution();
  if (chunk.blank() && coverage.fill() == Fill::empty) return {};
  // A row's own edges lead one voxel up, so the row below the stencil can change too.
  first_row_ = std::max(coverage.bottom() - 1 - place.y, 0);
  last_row_ = std::min(coverage.top() - place.y, resolution - 1);
  if (first_row_ > last_row_) return {};
  if (chunk.uniform() && chunk.full_ && coverage.fill() == Fill::filled) return {};

  materialise(chunk);
  set_states(coverage, place, chunk);
  set_crossings(Axis::x, coverage, place, chunk);
  set_crossings(Axis::y, coverage, place, chunk);
  Tally tally(resolution);
  for (int y = first_row_; y <= last_row_; ++y) {
    const auto k = static_cast<std::size_t>(y - first_row_);
    tally.add(y, states_[k], changes_[0][k], changes_[1][k]);
  }
  simplify(chunk);
  return tally.result();
}

void ChunkEdit::set_states(const Coverage& coverage, const ChunkPlace& place, Chunk& chunk) {
  states_.clear();
  std::vector<std::uint64_t>& words = chunk.body_.own().words;
  for (int y = first_row_; y <= last_row_; ++y) {
    std::uint64_t& row = words[Chunk::at(y)];
    const std::uint64_t before = row;
    const std::uint64_t covered = bits_from(coverage.run(place.y + y), place.x) & chunk.full_row();
    row = coverage.fill() == Fill::filled ? row | covered : row & ~covered;
    states_.push_back(row ^ before);
  }
}

void ChunkEdit::set_crossings(Axis axis, const Coverage& coverage, const ChunkPlace& place,
                              Chunk& chunk) {
  auto& changes = changes_[static_cast<int>(axis)];
  changes.clear(), masks_.clear(), counts_.clear(), packed_.clear();
  std::uint64_t any = 0;
  for (int y = first_row_; y <= last_row_; ++y) {
    const NewRow row = new_row(axis, y, coverage, place, chunk);
    const std::size_t before = packed_.size();
    changes.push_back(rebuild_row(axis, y, row, coverage, place, chunk));
    any |= changes.back();
    masks_.push_back(row.mask);
    counts_.push_back(static_cast<std::uint16_t>(packed_.size() - before));
  }
  if (any != 0) store_rows(axis, chunk);
}

ChunkEdit::NewRow ChunkEdit::new_row(Axis axis, int y, const Coverage& coverage,
                                     const ChunkPlace& place, const Chunk& chunk) const {
  const int last = chunk.resolution() - 1;
  const std::uint64_t row = chunk.row(y), full = chunk.full_row();
  const Run run = coverage.run(place.y + y);
  const std::uint64_t covered = bits_from(run, place.x) & full;
  std::uint64_t next, next_covered, edges = full;
  if (axis == Axis::x) {
    next = row >> 1 | bit(place.right && place.right->filled(0, y), last);
    next_covered = covered >> 1 | bit(covers(run, place.x + last + 1), last);
    if (!place.has_right) edges >>= 1;
  } else {
    next = y < last ? chunk.row(y + 1) : place.upper ? place.upper->row(0) : 0;
    next_covered = bits_from(coverage.run(place.y + y + 1), place.x) & full;
    if (y == last && !place.has_upper) edges = 0;
  }
  const std::uint64_t mask = (row ^ next) & edges;
  return {mask, mask & covered, mask & next_covered};
}

// Appends the row's crossings to packed_ and says which edges' are different from before.
std::uint64_t ChunkEdit::rebuild_row(Axis axis, int y, const NewRow& row, const Coverage& coverage,
                                     const ChunkPlace& place, const Chunk& chunk) {
  const std::uint64_t before = chunk.mask(axis, y);
  const auto old = chunk.crossings(axis, y);
  const std::uint64_t cut = row.lower | row.upper;
  std::uint64_t changed = before ^ row.mask;
  if (changed == 0 && cut == 0) {
    packed_.insert(packed_.end(), old.begin(), old.end());
    return 0;
  }
  std::size_t next_old = 0;
  for (std::uint64_t left = before | row.mask; left != 0; left &= left - 1) {
    const int x = std::countr_zero(left);
    const std::uint64_t here = left & (~left + 1);
    const Crossing* stored = (before & here) != 0 ? &old[next_old++] : nullptr;
    if ((row.mask & here) == 0) continue;
    if ((cut & here) == 0) {
      assert(stored);  // ends that were equal and now differ have one that is covered
      packed_.push_back(*stored);
      continue;
    }
    const End end = (row.lower & here) != 0 ? End::lower : End::upper;
    const Crossing fresh = coverage.cut(axis, place.x + x, place.y + y, end);
    const bool further = !stored || (end == End::lower ? fresh.offset > stored->offset
                                                       : fresh.offset < stored->offset);
    packed_.push_back(further ? fresh : *stored);
    if (further) changed |= here;
  }
  return changed;
}

// Puts the rebuilt rows where the old ones were, and moves the starts of the rows after them.
void ChunkEdit::store_rows(Axis axis, Chunk& chunk) {
  Chunk::Body& body = chunk.body_.own();
  std::copy(masks_.begin(), masks_.end(),
            body.words.begin() + static_cast<std::ptrdiff_t>(chunk.mask_offset(axis)) + first_row_);
  std::uint16_t* starts = body.starts.data() + chunk.start_offset(axis);
  auto& packed = body.packed[static_cast<int>(axis)];
  const std::size_t first = starts[first_row_], old_end = starts[last_row_ + 1];
  const std::size_t old_size = old_end - first, new_size = packed_.size();
  const auto at = packed.begin() + static_cast<std::ptrdiff_t>(first);
  if (new_size <= old_size) {
    const auto end = std::copy(packed_.begin(), packed_.end(), at);
    packed.erase(end, end + static_cast<std::ptrdiff_t>(old_size - new_size));
  } else {
    const auto split = packed_.begin() + static_cast<std::ptrdiff_t>(old_size);
    packed.reserve(packed.size() + new_size - old_size);
    const auto to = packed.begin() + static_cast<std::ptrdiff_t>(first);
    packed.insert(std::copy(packed_.begin(), split, to), split, packed_.end());
  }
  for (std::size_t k = 0; k < counts_.size(); ++k) {
    const std::size_t y = static_cast<std::size_t>(first_row_) + k;
    starts[y + 1] = static_cast<std::uint16_t>(starts[y] + counts_[k]);
  }
  for (int y = last_row_ + 1; y < chunk.resolution(); ++y) {
    starts[y + 1] = static_cast<std::uint16_t>(starts[y + 1] + new_size - old_size);
  }
}

void ChunkEdit::materialise(Chunk& chunk) {
  if (chunk.body_) return;
  const std::size_t resolution = chunk.resolution_;
  Chunk::Body body;
  body.words.resize(3 * resolution);
  if (chunk.full_) std::fill_n(body.words.begin(), resolution, chunk.full_row());
  body.starts.resize(2 * (resolution + 1));
  chunk.body_ = CopyOnWrite(std::move(body));
}

// Without crossings all voxels are alike, because two that differ have one somewhere between.
void ChunkEdit::simplify(Chunk& chunk) {
  auto& packed = chunk.body_.own().packed;
  if (packed[0].empty() && packed[1].empty()) {
    chunk.full_ = chunk.body_->words[0] != 0;
    chunk.body_.reset();
    return;
  }
  for (auto& crossings : packed) {
    if (crossings.capacity() > 2 * crossings.size() + 16) crossings.shrink_to_fit();
  }
}

}  // namespace earthwork::voxel
