#include "server/room/presence_board.hpp"

#include <algorithm>
#include <cassert>
#include <memory>
#include <utility>

namespace earthwork::room {
namespace {

// Whoever is further behind is told everything anew. So a version has few texts, however many
// viewers read slowly.
constexpr std::uint64_t kMostVersionsBehind = 64;
constexpr std::size_t kMostDepartures = 1024;

}  // namespace

void PresenceBoard::enter(ViewerId id, protocol::User user) {
  Person& person = people_[id];
  person.user = std::move(user);
  person.known = version_;
  if (listed_ < kMaxListedUsers)
    list(id, person);
  else
    unlisted_.insert(id);
  person.lost = listed_ > kMaxJoinedUsers;
  changed_ = true;
}

void PresenceBoard::list(ViewerId id, Person& person) {
  unlisted_.erase(id);
  ++listed_;
  person.listed = true;
  person.listed_at = next();
  come_back(person);
  if (person.at || person.view) person.pointed_at = person.listed_at;
}

// Of a session that left and is here again only the second is told, and that its cursor of before
// is gone.
void PresenceBoard::come_back(Person& person) {
  const auto gone = std::erase_if(departures_, [&](const Departure& departure) {
    return departure.session == person.user.session;
  });
  if (gone != 0) person.pointed_at = next();
}

void PresenceBoard::leave(ViewerId id) {
  const auto found = people_.find(id);
  if (found == people_.end()) return;
  const Person person = std::move(found->second);
  people_.erase(found);
  unlisted_.erase(id);
  if (!person.listed) return;

  --listed_;
  depart(person.user.session);
  if (!unlisted_.empty()) {
    const ViewerId first = *unlisted_.begin();
    list(first, people_.at(first));
  }
}

void PresenceBoard::depart(const std::string& session) {
  departures_.push_back({next(), session});
  if (departures_.size() <= kMostDepartures) return;
  forgotten_ = departures_.front().version;
  departures_.pop_front();
}

void PresenceBoard::point(ViewerId id, const protocol::Cursor& cursor, std::int64_t now_ms) {
  const auto found = people_.find(id);
  if (found == people_.end()) return;
  Person& person = found->second;
  person.pointed_ms = now_ms;
  const auto brush = cursor.at ? cursor.brush : std::nullopt;
  if (person.at == cursor.at && person.brush == brush && person.view == cursor.view) return;
  person.at = cursor.at;
  person.brush = brush;
  person.view = cursor.view;
  if (person.listed) person.pointed_at = next();
}

std::optional<std::int64_t> PresenceBoard::hide_old(std::int64_t now_ms) {
  std::optional<std::int64_t> first;
  for (auto& [id, person] : people_) {
    if (!person.at) continue;
    const std::int64_t due_ms = person.pointed_ms + kCursorMs;
    if (due_ms > now_ms) {
      first = std::min(first.value_or(due_ms), due_ms);
      continue;
    }
    person.at.reset();
    person.brush.reset();
    if (person.listed) person.pointed_at = next();
  }
  return first;
}

const protocol::User* PresenceBoard::user_of(ViewerId id) const {
  const auto found = people_.find(id);
  return found == people_.end() ? nullptr : &found->second.user;
}

std::vector<protocol::User> PresenceBoard::users_for(ViewerId id) const {
  std::vector<protocol::User> users;
  for (const auto& [other, person] : people_) {
    if (users.size() == kMaxJoinedUsers - 1) break;
    if (person.listed && other != id) users.push_back(person.user);
  }
  if (const auto own = people_.find(id); own != people_.end()) users.push_back(own->second.user);
  return users;
}

void PresenceBoard::advance() {
  ++version_;
  changed_ = false;
  news_.clear();
}

PresenceBoard::Knowledge PresenceBoard::knowledge_of(const Person& person) const {
  const bool lost =
      person.lost || person.known < forgotten_ || version_ - person.known > kMostVersionsBehind;
  if (lost) return {};
  return {person.known, person.newcomer};
}

SharedText PresenceBoard::news_for(ViewerId id) {
  const auto found = people_.find(id);
  if (found == people_.end() || found->second.known == version_) return nullptr;
  Person& person = found->second;
  const Knowledge knowledge = knowledge_of(person);
  const auto [news, is_new] = news_.try_emplace(knowledge);
  if (is_new) news->second = write_news(knowledge);
  person.known = version_;
  person.newcomer = person.lost = false;
  return news->second.sole == id ? nullptr : news->second.text;
}

PresenceBoard::News PresenceBoard::write_news(const Knowledge& knowledge) const {
  protocol::Presence news{.all = !knowledge.version, .users = {}, .left = {}, .cursors = {}};
  const bool every_cursor = news.all || knowledge.newcomer;
  const std::uint64_t known = knowledge.version.value_or(0);
  std::set<ViewerId> about;
  // What is newer than the version is told with the next one.
  const auto is_news = [&](std::uint64_t version) {
    return version > known && version <= version_;
  };

  for (const auto& [id, person] : people_) {
    if (!person.listed) continue;
    const bool came = news.all ? person.listed_at <= version_ : is_news(person.listed_at);
    const bool unknown = every_cursor && (person.at || person.view);
    const bool moved = unknown || (!news.all && is_news(person.pointed_at));
    if (came) news.users.push_back(person.user);
    if (moved) news.cursors.push_back({person.user.session, person.at, person.brush, person.view});
    if (came || moved) about.insert(id);
  }
  for (const Departure& departure : departures_)
    if (!news.all && is_news(departure.version)) news.left.push_back(departure.session);

  if (!news.all && about.empty() && news.left.empty()) return {};
  const bool sole = !news.all && about.size() == 1 && news.left.empty();
  return {std::make_shared<const std::string>(protocol::write(news)), sole ? *about.begin() : 0};
}

}  // namespace earthwork::room
