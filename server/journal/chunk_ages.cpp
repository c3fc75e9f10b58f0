#include "server/journal/chunk_ages.hpp"

#include <algorithm>

namespace earthwork::journal {

std::vector<ChunkAge> ChunkAges::in_order() const {
  std::vector<ChunkAge> ages;
  ages.reserve(seqs_.size());
  for (const auto& [key, seq] : seqs_) ages.push_back({key, seq});
  std::ranges::sort(ages, {}, &ChunkAge::key);
  return ages;
}

}  // namespace earthwork::journal
