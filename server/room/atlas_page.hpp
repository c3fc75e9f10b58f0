/// What an atlas knows of one map, and how it parts with the map's room.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "server/room/atlas.hpp"
#include "server/room/chat_log.hpp"
#include "server/room/room_maker.hpp"

namespace earthwork::room {

struct Page {
  enum class State {
    closed,    // it lies on the shelf
    opening,   // is being made, or read
    live,      // has a room
    closing,   // the room closes; its journal is not closed yet
    removing,  // leaves the shelf
  };

  State state = State::closed;
  std::shared_ptr<Room> room{};          // while live
  std::shared_ptr<Lease> lease{};        // of the room's clerk, while live or closing
  std::weak_ptr<Room> parting{};         // while closing, if anybody still holds it
  std::uint64_t opening = 0;             // which one brought the room that it has, or had last
  bool visited = false;                  // somebody came in since it was opened, or is about to
  std::vector<Atlas::Opened> waiting{};  // for a room
  Atlas::Erased erasing{};               // set: it is being deleted, and nobody finds it any more
  std::optional<std::uint64_t> epoch{};  // once known
  std::shared_ptr<ChatLog> chat{};       // since it was opened first; its rooms go on in it
  std::optional<protocol::Failure> trouble{};  // why it could not be opened the last time
  std::int64_t trouble_until_ms = 0;           // no new try before

  /// The room is not live any more, whoever still holds it.
  [[nodiscard]] RoomMaker::Furnished take_room() {
    state = State::closing;
    if (room) parting = room;
    return {std::exchange(room, nullptr), lease};
  }
};

/// On the room's strand, later: the room closes, and its clerk is given back.
inline void close_later(const RoomMaker::Furnished& map, const protocol::Failure& why) {
  map.room->strand().post([map, why] {
    map.room->close({.failure = why, .retry_after_ms = {}});
    map.lease->end();
  });
}

/// What it accepted is stored first, if it can be.
inline void flush_and_close(const RoomMaker::Furnished& map, const protocol::Failure& why) {
  map.room->strand().post(
      [map, why] { map.room->once_durable([map, why](bool) { close_later(map, why); }); });
}

}  // namespace earthwork::room
