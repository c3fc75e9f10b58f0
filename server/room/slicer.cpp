#include "server/room/slicer.hpp"

#include <cassert>

#include "server/history/fold.hpp"
#include "server/voxel/reach.hpp"

namespace earthwork::room {

std::uint64_t rows_visited(const protocol::Edit& edit, const protocol::MapSettings& settings) {
  const auto resolution = static_cast<std::uint64_t>(settings.chunk_resolution);
  const double side_voxels = 2 * edit.radius / settings.voxel_size;
  const std::uint64_t side = static_cast<std::uint64_t>(side_voxels) / resolution + 2;
  return side * side * resolution * edit.path.size();
}

bool Slicer::must_wait(const Line::Waiting& edit) const {
  if (!busy()) return false;
  if (too_large(edit)) return true;
  const auto* asked = std::get_if<protocol::Edit>(&edit.command.action);
  if (!asked) return false;
  const voxel::Reach reach(map_.grid(), static_cast<int>(asked->layer), history::stencils(*asked));
  return prepared_->edit.reach().meets(reach);
}

void Slicer::start(const Command& command) {
  assert(!busy());
  const auto& asked = std::get<protocol::Edit>(command.action);
  prepared_.emplace(command.author, voxel::SlicedEdit(map_, static_cast<int>(asked.layer),
                                                      history::stencils(asked)));
}

void Slicer::advance() {
  const auto resolution = static_cast<std::uint64_t>(map_.grid().resolution);
  prepared_->through = prepared_->edit.advance(kSliceRows / resolution);
}

voxel::Change Slicer::commit() {
  assert(through());
  voxel::Change change = prepared_->edit.commit(map_);
  clear();
  return change;
}

}  // namespace earthwork::room
