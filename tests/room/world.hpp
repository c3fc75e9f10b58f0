/// A room with guests, on a strand that runs when the test says so.
#pragma once

#include <cstdint>
#include <memory>

#include "server/room/manual_context.hpp"
#include "server/room/room.hpp"
#include "tests/room/onlooker.hpp"

namespace earthwork::room {

/// Of resolution 8 unless told otherwise, so that small edits cross chunks.
struct World {
  explicit World(protocol::MapSettings settings = {.chunk_resolution = 8, .chunks = {}});

  struct Guest {
    std::shared_ptr<Onlooker> eyes = std::make_shared<Onlooker>();
    ViewerId id = 0;
    std::uint64_t author = 0;
    protocol::MessageId last_message = 0;
  };
  /// Under an author and a session of its own: 7, 8, 9 ...; or the author that is given.
  Guest enter(const char* name = "ann", std::uint64_t author = 0);
  /// Throws when the view is refused; then the guest takes all that comes.
  void look(Guest& guest, const protocol::View& view);
  protocol::Result<void> submit(Guest& guest, protocol::Edit edit);
  /// Throws when the edit is refused; runs the strand.
  void edit(Guest& guest, protocol::Edit edit);
  /// The guest takes parcels until none comes any more.
  void settle(Guest& guest);
  /// Of the room, every mesh up to date.
  std::uint64_t mesh_hash();

  ManualContext context;
  std::shared_ptr<Meters> meters = std::make_shared<Meters>();
  std::shared_ptr<Room> room;
  std::uint64_t last_session = 6;
};

}  // namespace earthwork::room
