/// What a room begins with: a map as it was left, the journal that it goes on in, and what was said
/// there.
#pragma once

#include <cstdint>
#include <memory>

#include "protocol/settings.hpp"
#include "server/journal/clerk.hpp"
#include "server/journal/journal.hpp"
#include "server/journal/restore.hpp"
#include "server/room/chat_log.hpp"

namespace earthwork::room {

/// What a journal's appends are like.
enum class Commits {
  later,    ///< They take a while, and may fail.
  at_once,  ///< They end within the call, and never fail: nothing is kept to take them back.
};

struct Opening {
  journal::Identity identity;
  journal::Restored restored;  ///< The whole journal; an empty map for a new one.
  std::unique_ptr<journal::Clerk> clerk;
  Commits commits = Commits::later;
  std::shared_ptr<ChatLog> chat{};  ///< Null: nothing was said, and it ends with the room.
};

/// Of a new, empty map that ends with the process.
[[nodiscard]] Opening open_in_memory(const journal::Identity& identity);
/// The same over a clerk of the caller's, whose journal is empty.
[[nodiscard]] Opening open_empty(const journal::Identity& identity,
                                 std::unique_ptr<journal::Clerk> clerk, Commits commits);

}  // namespace earthwork::room
