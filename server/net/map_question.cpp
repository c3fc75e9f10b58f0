#include "server/net/map_question.hpp"

#include <utility>

namespace earthwork::net {

HttpResponse map_problem(protocol::Failure failure) {
  failure.field.clear();
  return problem(failure);
}

void ask_map(room::Atlas& atlas, const std::string& map, Question question, Respond respond,
             int tries) {
  if (tries == 0)
    return respond(problem({protocol::Code::unavailable,
                            "map: what it would show could not be stored; try again", "map"}));
  auto ask = [&atlas, map, question = std::move(question), respond = std::move(respond),
              tries](const protocol::Result<RoomPointer>& room) {
    if (!room) return respond(map_problem(room.error()));
    question(*room, [&atlas, map, question, respond, tries,
                     there = *room](std::optional<HttpResponse> answer) {
      if (answer) return respond(std::move(*answer));
      there->strand().post([&atlas, map, question, respond, tries, there] {
        if (there->closed()) atlas.let_go(*there);
        ask_map(atlas, map, question, respond, tries - 1);
      });
    });
  };
  atlas.open(map, room::Atlas::Errand::question, std::move(ask));
}

}  // namespace earthwork::net
