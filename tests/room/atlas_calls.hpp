/// An atlas whose maps are in memory answers within each call: as plain functions.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "server/room/atlas.hpp"

namespace earthwork::room {

/// What `call` is answered, given a function that takes the answer. Throws when it was not answered
/// within the call.
template <class Answer, class Call>
Answer answer_of(Call call) {
  std::optional<Answer> answer;
  call([&answer](const Answer& given) { answer = given; });
  return std::move(answer).value();
}

inline protocol::Result<std::shared_ptr<Room>> create_map(
    Atlas& atlas, const std::string& name, const protocol::MapSettings& settings = {}) {
  return answer_of<protocol::Result<std::shared_ptr<Room>>>(
      [&](auto done) { atlas.create(name, settings, std::move(done)); });
}

/// Null when there is none.
inline std::shared_ptr<Room> find_map(Atlas& atlas, const std::string& name) {
  return answer_of<protocol::Result<std::shared_ptr<Room>>>(
             [&](auto done) { atlas.open(name, Atlas::Errand::question, std::move(done)); })
      .value_or(nullptr);
}

/// The answer may need the map's strand: whether it came is not told.
inline void erase_map(Atlas& atlas, const std::string& name) {
  atlas.erase(name, [](const protocol::Result<void>&) {});
}

}  // namespace earthwork::room
