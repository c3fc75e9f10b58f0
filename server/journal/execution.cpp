#include "server/journal/execution.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "protocol/chunk_record.hpp"
#include "protocol/limits.hpp"
#include "server/history/fold.hpp"
#include "server/journal/damage.hpp"

namespace earthwork::journal {
namespace {

tl::unexpected<protocol::Failure> damaged(std::uint64_t seq, const std::string& sentence) {
  return damage({}, {}, seq, sentence);
}

// Limits of edits may become narrower, and what was accepted stays. But a file of anybody must not
// send a stencil beyond all numbers, or fill the world with one: nothing was ever accepted that
// goes beyond these.
constexpr double kWidestRadiusVoxels = 8192, kFurthestVoxels = 1 << 24;
static_assert(protocol::kMaxRadiusVoxels <= kWidestRadiusVoxels);
static_assert(protocol::kMaxCoordinateVoxels <= kFurthestVoxels);

bool ever_acceptable(const protocol::Edit& edit, double voxel_size) {
  if (!(edit.radius / voxel_size <= kWidestRadiusVoxels)) return false;
  for (const protocol::MapPoint& point : edit.path)
    if (!(std::abs(point.x / voxel_size) <= kFurthestVoxels) ||
        !(std::abs(point.y / voxel_size) <= kFurthestVoxels))
      return false;
  return true;
}

protocol::Result<void> check(const protocol::Action& action,
                             const protocol::MapSettings& settings) {
  if (auto checked = protocol::check_layers(action, settings); !checked) return checked;
  const auto* edit = std::get_if<protocol::Edit>(&action);
  if (!edit || ever_acceptable(*edit, settings.voxel_size)) return {};
  return protocol::fail(protocol::Code::damaged, "an edit beyond all limits");
}

}  // namespace

Execution::Execution(protocol::MapSettings at_first)
    : settings(std::move(at_first)), map(history::make_map(settings)) {}

protocol::Result<void> Execution::apply(const history::Event& event) {
  if (event.seq != seq + 1) return damaged(event.seq, std::to_string(seq + 1) + " comes next");
  if (auto possible = check(event.action, settings); !possible)
    return damaged(event.seq, possible.error().detail);
  if (!authors.add(event.author, {event.id, event.seq}))
    return damaged(event.seq, "id " + std::to_string(event.id) +
                                  " is not above the last of author " +
                                  protocol::hex(event.author));
  protocol::apply(event.action, settings);
  const voxel::Change& change = history::apply(map, event.action);
  ages.changed(change.changed, event.seq);
  seq = event.seq;
  hash = map.hash();
  if (hash == event.hash) return {};
  return damaged(seq, "the stored hash is " + protocol::hex(event.hash) + ", executed it is " +
                          protocol::hex(hash));
}

}  // namespace earthwork::journal
