#include "client/viewer/people.hpp"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

namespace earthwork::viewer {

void People::join(const std::vector<protocol::User>& users, std::string me) {
  me_ = std::move(me);
  persons_.clear();
  for (const protocol::User& user : users) put(user);
}

void People::take(const protocol::Presence& presence) {
  if (presence.all) keep_only(presence.users);
  for (const protocol::User& user : presence.users) put(user);
  for (const std::string& session : presence.left) persons_.erase(session);
  for (const protocol::UserCursor& moved : presence.cursors) {
    const auto found = persons_.find(moved.session);
    if (found == persons_.end()) continue;
    found->second.cursor = moved.at;
    found->second.brush = moved.at ? moved.brush : std::nullopt;
    found->second.view = moved.view;
  }
}

void People::clear() { persons_.clear(); }

void People::put(const protocol::User& user) {
  const auto found = persons_.find(user.session);
  if (found != persons_.end())
    found->second.user = user;
  else if (persons_.size() < kMaxPeople)
    persons_[user.session].user = user;
}

/// Of a list of all: others are gone, and so is every cursor that is not said with it.
void People::keep_only(const std::vector<protocol::User>& users) {
  std::set<std::string> there;
  for (const protocol::User& user : users) there.insert(user.session);
  for (auto at = persons_.begin(); at != persons_.end();) {
    at->second.cursor.reset();
    at->second.brush.reset();
    at->second.view.reset();
    at = there.contains(at->first) ? std::next(at) : persons_.erase(at);
  }
}

const People::Person* People::find(const std::string& session) const {
  const auto found = persons_.find(session);
  return found == persons_.end() ? nullptr : &found->second;
}

PeoplePart People::part(const std::string& followed) const {
  PeoplePart part;
  for (const auto& [session, person] : persons_)
    part.people.push_back({.session = session,
                           .name = person.user.name,
                           .color = person.user.color,
                           .me = is_me(session),
                           .has_view = !is_me(session) && person.view.has_value(),
                           .followed = session == followed});
  std::sort(part.people.begin(), part.people.end(), [](const auto& a, const auto& b) {
    return std::tie(b.me, a.name, a.session) < std::tie(a.me, b.name, b.session);
  });
  return part;
}

}  // namespace earthwork::viewer
