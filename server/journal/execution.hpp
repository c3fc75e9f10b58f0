/// A map that follows a log: brought forward event by event, and what comes of each compared with
/// what the log says came of it.
#pragma once

#include <cstdint>

#include "protocol/settings.hpp"
#include "server/history/event.hpp"
#include "server/journal/author_book.hpp"
#include "server/journal/chunk_ages.hpp"
#include "server/voxel/map.hpp"

namespace earthwork::journal {

/// What there is as of `seq`; an empty map at seq 0. Whoever has it otherwise, from a keyframe,
/// sets it.
struct Execution {
  /// The settings as of where it starts.
  explicit Execution(protocol::MapSettings at_first);

  /// Applies the event. Fails with `damaged` when its seq is not the next one, when the map has no
  /// such layer, when its action or its id is none that can have been accepted, and when the map's
  /// hash after it is not the event's; the detail begins with "seq N: ". After a failure the map is
  /// not to be used.
  [[nodiscard]] protocol::Result<void> apply(const history::Event& event);

  protocol::MapSettings settings;
  voxel::Map map;
  ChunkAges ages;
  AuthorBook authors;
  std::uint64_t seq = 0, hash = 0;
};

}  // namespace earthwork::journal
