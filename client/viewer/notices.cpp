#include "client/viewer/notices.hpp"

#include <utility>

namespace earthwork::viewer {

void Notices::add(Kind kind, std::string words, std::optional<protocol::MapPoint> at, Time now) {
  auto& notices = part_.notices;
  const bool again = !notices.empty() && now < until_.back() && notices.back().kind == kind &&
                     notices.back().words == words;
  if (again || notices.size() == kKeptNotices) {
    const auto old = static_cast<std::ptrdiff_t>(again ? notices.size() - 1 : 0);
    notices.erase(notices.begin() + old);
    until_.erase(until_.begin() + old);
  }
  notices.push_back({.n = ++last_, .kind = kind, .words = std::move(words), .at = at});
  until_.push_back(now + kNoticeShown);
}

std::vector<const NoticesPart::Notice*> Notices::shown(Time now) const {
  std::vector<const NoticesPart::Notice*> out;
  for (std::size_t i = 0; i < until_.size(); ++i)
    if (part_.notices[i].at && now < until_[i]) out.push_back(&part_.notices[i]);
  return out;
}

std::optional<Notices::Time> Notices::due(Time now) const {
  for (std::size_t i = 0; i < until_.size(); ++i)
    if (part_.notices[i].at && now < until_[i]) return until_[i];
  return std::nullopt;
}

}  // namespace earthwork::viewer
