/// Who is on the map, where they point and what they see.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "client/viewer/panel_state.hpp"
#include "protocol/messages.hpp"

namespace earthwork::viewer {

/// More are not kept, whatever a server says.
inline constexpr std::size_t kMaxPeople = 2000;

class People {
 public:
  struct Person {
    protocol::User user;
    std::optional<protocol::MapPoint> cursor;
    std::optional<protocol::Brush> brush;   ///< In hand, where the cursor is.
    std::optional<protocol::MapRect> view;  ///< What they see, when they say so.
  };
  using Persons = std::map<std::string, Person>;  ///< By session.

  /// A map was joined, as `me`.
  void join(const std::vector<protocol::User>& users, std::string me);
  void take(const protocol::Presence& presence);
  /// Nobody is there, as far as one knows.
  void clear();

  [[nodiscard]] const Persons& persons() const { return persons_; }
  [[nodiscard]] const Person* find(const std::string& session) const;
  [[nodiscard]] bool is_me(const std::string& session) const { return session == me_; }
  /// `followed`: their session, or nobody's.
  [[nodiscard]] PeoplePart part(const std::string& followed) const;

 private:
  void put(const protocol::User& user);
  void keep_only(const std::vector<protocol::User>& users);

  Persons persons_;
  std::string me_;
};

}  // namespace earthwork::viewer
