#include "client/viewer/painter.hpp"

#include <utility>

namespace earthwork::viewer {

using Kind = Notices::Kind;

void Painter::begin(const scene::BrushSettings& brush, const protocol::MapSettings& settings,
                    protocol::MapPoint at, Time now) {
  end(now);
  told_full_ = false;
  stroke_.emplace(brush, settings, next_number_, at, now);
  flush(now);
}

void Painter::draw_to(protocol::MapPoint at, Time now) {
  if (stroke_) stroke_->draw_to(at, now);
}

void Painter::flush(Time now) {
  if (!stroke_) return;
  for (const protocol::Edit& edit : stroke_->take()) {
    const auto kept = keep_(edit);
    if (kept) {
      ends_.emplace(*kept, edit.path.back());
    } else if (!std::exchange(told_full_, true)) {
      notices_.add(Kind::lost, "Not painted: " + kept.error().detail, edit.path.back(), now);
    }
  }
  next_number_ = stroke_->next_number();
}

void Painter::end(Time now) {
  if (stroke_) stroke_->finish(now);
  flush(now);
  stroke_.reset();
}

void Painter::take(const std::vector<link::Answer>& answers, Time now) {
  std::size_t lost = 0;
  std::string why;
  std::optional<protocol::MapPoint> where;
  for (const link::Answer& answer : answers) {
    if (answer.fate == link::Fate::rejected) tell_refused(answer, now);
    const auto at = forget(answer.id);
    if (answer.fate != link::Fate::lost) continue;
    ++lost;
    why = answer.why.detail;
    if (at) where = at;
  }
  if (lost == 0) return;
  const std::string what = lost == 1 ? "1 edit: " : std::to_string(lost) + " edits: ";
  notices_.add(Kind::lost, what + why, where, now);
}

void Painter::tell_refused(const link::Answer& answer, Time now) {
  const auto found = ends_.find(answer.id);
  if (found == ends_.end())
    notices_.add(Kind::rejected, "The layer was not changed: " + answer.why.detail, {}, now);
  else
    notices_.add(Kind::rejected, "Not painted: " + answer.why.detail, found->second, now);
}

std::optional<protocol::MapPoint> Painter::forget(protocol::MessageId id) {
  const auto found = ends_.find(id);
  if (found == ends_.end()) return std::nullopt;
  const protocol::MapPoint at = found->second;
  ends_.erase(found);
  return at;
}

}  // namespace earthwork::viewer
