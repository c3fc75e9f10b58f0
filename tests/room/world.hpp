/// A room with guests, on a strand that runs when the test says so.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "server/history/event.hpp"
#include "server/journal/journal.hpp"
#include "server/room/manual_context.hpp"
#include "server/room/room.hpp"
#include "tests/room/onlooker.hpp"

namespace earthwork::room {

/// Small edits cross chunks.
inline const protocol::MapSettings kSmallChunks{.chunk_resolution = 8, .chunks = {}};

/// Over a journal in memory, whose commits are at once.
struct World {
  explicit World(const protocol::MapSettings& settings = kSmallChunks);

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
  protocol::Result<void> submit(Guest& guest, protocol::Action action);
  /// Throws when it is refused; runs the strand.
  void edit(Guest& guest, protocol::Action action);
  /// The guest takes parcels until none comes any more.
  void settle(Guest& guest);
  /// Of the room, every mesh up to date.
  std::uint64_t mesh_hash();
  /// All that is durable.
  std::vector<history::Event> events();

  ManualContext context;
  std::shared_ptr<Meters> meters = std::make_shared<Meters>();
  std::shared_ptr<Room> room;
  journal::Journal* journal = nullptr;  // the room's clerk's
  std::uint64_t last_session = 6;

 protected:
  World(Opening opening, journal::Journal& its_journal);
};

[[nodiscard]] journal::Identity identity_of(const protocol::MapSettings& settings);

}  // namespace earthwork::room
