/// A question to a map that may have to be opened for it, and asked again when what it showed was
/// not to last.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "server/net/http_message.hpp"
#include "server/room/atlas.hpp"

namespace earthwork::net {

using RoomPointer = std::shared_ptr<room::Room>;

/// How often a map is asked before the answer is 503.
inline constexpr int kMaxTries = 3;

/// Takes the answer; nothing when what it would have shown was taken back, or the room was closed,
/// before all of it was stored. Any thread may call it, once.
using Given = std::function<void(std::optional<HttpResponse>)>;
using Question = std::function<void(const RoomPointer& room, Given give)>;

/// Why there is no answer for a map that is named by the request's path, so by no field.
[[nodiscard]] HttpResponse map_problem(protocol::Failure failure);

/// Asks the map's room, a new one each time, until it gives an answer, and responds with that. The
/// atlas outlives it.
void ask_map(room::Atlas& atlas, const std::string& map, Question question, Respond respond,
             int tries = kMaxTries);

}  // namespace earthwork::net
