#include "client/viewer/cursor_teller.hpp"

#include <algorithm>

#include "protocol/limits.hpp"

namespace earthwork::viewer {
namespace {

protocol::MapRect within_limits(const protocol::MapRect& view, double voxel_size) {
  const double most = protocol::kMaxCoordinateVoxels * voxel_size;
  const auto clamped = [&](double at) { return std::clamp(at, -most, most); };
  return {clamped(view.x0), clamped(view.y0), clamped(view.x1), clamped(view.y1)};
}

}  // namespace

bool CursorTeller::tell(const protocol::Cursor& cursor, Time now) {
  const bool new_to_them = !said_ || *said_ != cursor;
  const Time from = said_at_ + (new_to_them ? Time::duration(kCursorEvery) : kCursorAgain);
  if (said_ && now < from) {
    due_ = from;
    return false;
  }
  said_ = cursor;
  said_at_ = now;
  due_ = now + kCursorAgain;
  return true;
}

void CursorTeller::forget() {
  said_.reset();
  due_.reset();
}

protocol::Cursor cursor_of(std::optional<protocol::MapPoint> at,
                           const std::optional<protocol::Brush>& brush,
                           const protocol::MapRect& view, const protocol::MapSettings& settings) {
  protocol::Cursor cursor{
      .at = {}, .brush = {}, .view = within_limits(view, settings.voxel_size), .id = {}};
  if (!at) return cursor;
  const protocol::Brush stamp = brush.value_or(protocol::Brush{});
  const protocol::Edit edit{.layer = stamp.layer,
                            .stencil = stamp.stencil,
                            .fill = stamp.fill,
                            .radius = stamp.radius,
                            .path = {*at},
                            .stroke = {}};
  if (!protocol::check_edit(edit, settings)) return cursor;
  cursor.at = at;
  cursor.brush = brush;
  return cursor;
}

}  // namespace earthwork::viewer
