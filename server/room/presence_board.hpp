/// Who takes part in a map, where they point and what they see, and what of it each of them does
/// not know yet.
///
/// Changes are gathered into versions. Somebody who knows one version is told all that is new in
/// the current one, in one message; whoever knows the same version is told the same text, which is
/// written once. So nobody is owed more than a number, however slowly it reads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "protocol/messages.hpp"
#include "server/room/viewer.hpp"

namespace earthwork::room {

/// So many are listed to each other, whoever came first; it keeps a message that lists all far
/// below kMaxServerControlBytes. Who is beyond sees the others and is not seen, until one goes.
inline constexpr std::size_t kMaxListedUsers = 1000;
/// `joined` lists this many; of a larger crowd the first presence lists all. A presence is written
/// once for everybody, `joined` for each who comes.
inline constexpr std::size_t kMaxJoinedUsers = 64;
/// A cursor that was not said again for so long is hidden.
inline constexpr std::int64_t kCursorMs = 30'000;

/// One thread at a time.
class PresenceBoard {
 public:
  /// `id` is new. Everybody is to be told, and it is to be told of all cursors and views.
  void enter(ViewerId id, protocol::User user);
  void leave(ViewerId id);
  /// Of what comes before the next version the last one counts. The same again only renews it. The
  /// view is that of the last cursor, a hidden one's too, until its owner leaves.
  void point(ViewerId id, const protocol::Cursor& cursor, std::int64_t now_ms);
  /// Hides the cursors that are too old, and says when the next one will be, if there is any.
  std::optional<std::int64_t> hide_old(std::int64_t now_ms);

  /// Null for who is not there; else valid until it leaves.
  [[nodiscard]] const protocol::User* user_of(ViewerId id) const;
  /// For who has just entered: those who are listed, up to kMaxJoinedUsers with itself, the last.
  [[nodiscard]] std::vector<protocol::User> users_for(ViewerId id) const;

  /// Something changed since the current version.
  [[nodiscard]] bool changed() const { return changed_; }
  /// Makes what changed the current version.
  void advance();
  /// What the viewer does not know of the current version; null when that is nothing, or only what
  /// it did itself. It knows it from now on.
  [[nodiscard]] SharedText news_for(ViewerId id);

 private:
  struct Person {
    protocol::User user;
    bool listed = false;
    bool newcomer = true;         // knows no cursor and no view yet,
    bool lost = false;            // nor who is there
    std::uint64_t known = 0;      // the version that it was told of
    std::uint64_t listed_at = 0;  // the version in which it came
    std::optional<protocol::MapPoint> at;
    std::optional<protocol::Brush> brush;
    std::optional<protocol::MapRect> view;  // stays when the cursor is hidden for its age
    std::uint64_t pointed_at = 0;           // the version in which cursor or view changed; 0 never
    std::int64_t pointed_ms = 0;
  };
  struct Departure {
    std::uint64_t version = 0;
    std::string session;
  };
  struct News {
    SharedText text;    // null: none
    ViewerId sole = 0;  // all of it is about this one; 0 when it is about others too
  };
  /// What somebody knows: a version, and the cursors of then unless it is a newcomer.
  struct Knowledge {
    std::optional<std::uint64_t> version;  // none: too little to go on from
    bool newcomer = false;
    friend auto operator<=>(const Knowledge&, const Knowledge&) = default;
  };

  [[nodiscard]] std::uint64_t next() { return changed_ = true, version_ + 1; }
  void list(ViewerId id, Person& person);
  void depart(const std::string& session);
  void come_back(Person& person);
  [[nodiscard]] Knowledge knowledge_of(const Person& person) const;
  [[nodiscard]] News write_news(const Knowledge& knowledge) const;

  std::map<ViewerId, Person> people_;
  std::set<ViewerId> unlisted_;
  std::size_t listed_ = 0;
  std::uint64_t version_ = 0;
  bool changed_ = false;
  std::deque<Departure> departures_;  // the last ones, by version
  std::uint64_t forgotten_ = 0;       // departures up to this version may be missing
  std::map<Knowledge, News> news_;    // of the current version
};

}  // namespace earthwork::room
