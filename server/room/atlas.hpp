/// All maps of a server, by name: those that have a room now, and those that only lie on the shelf
/// until somebody asks for them.
///
/// A map is opened when it is asked for, once, however many ask meanwhile; it is put away again
/// when nobody is inside and nobody has used it for a while. What cannot be opened is refused by
/// itself, and tried again after some seconds at the earliest. A room that closed itself is let go
/// of too: the next one who asks gets a new one, from what was stored.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "protocol/result.hpp"
#include "protocol/settings.hpp"
#include "server/journal/shelf.hpp"
#include "server/room/room.hpp"

namespace earthwork::room {

inline constexpr std::size_t kMaxMaps = 4096;
/// That are opened, closed and removed at a time.
inline constexpr int kMaxMapsUnderWay = 4;
/// How long a map stays that nobody has joined since it was opened, if `idle` is not shorter.
inline constexpr std::chrono::seconds kAskedMapIdle{5};
/// For how long a map that could not be opened is refused without a new try.
inline constexpr std::chrono::seconds kTroublePause{3};

struct AtlasOptions {
  /// Called for each room, from any thread.
  std::function<std::unique_ptr<Strand>()> make_strand;
  std::shared_ptr<journal::Shelf> shelf = journal::make_memory_shelf();
  /// Runs a task that takes long off every strand, and off the calling thread unless that may be
  /// held up. Not called for a shelf that keeps nothing: there all is done within the calls.
  std::function<void(Strand::Task)> aside = [](const Strand::Task& task) { task(); };
  std::chrono::milliseconds idle{60'000};                       ///< After which a map is put away.
  std::shared_ptr<Meters> meters = std::make_shared<Meters>();  ///< All rooms count there.
};

/// What was said on a map is kept with it as long as the atlas is there, whether the map is in
/// memory or put away, within kMaxChatBytes for all maps; it goes when the map is deleted.
///
/// Any thread. What is called back is called once: within the call where nothing has to be waited
/// for, else from any thread.
class Atlas {
 public:
  using Opened = std::function<void(protocol::Result<std::shared_ptr<Room>>)>;
  using Erased = std::function<void(protocol::Result<void>)>;

  explicit Atlas(AtlasOptions options);
  /// Rooms that still live are let go of; `stop` is what waits for their journals. After one that
  /// ran out of patience the strands must have ended, and what it waited for is waited for here.
  ~Atlas();
  Atlas(const Atlas&) = delete;
  Atlas& operator=(const Atlas&) = delete;

  /// Learns which maps the shelf has, and opens none: once, before anything else. Fails as
  /// Shelf::names does.
  [[nodiscard]] protocol::Result<void> take_stock();

  /// A new, empty map; it is kept when `done` is called. `settings` is valid. Fails with bad_name,
  /// with map_exists also while one of that name is being deleted, with too_large when there are
  /// kMaxMaps, and as a journal does.
  void create(const std::string& name, const protocol::MapSettings& settings, Opened done);

  /// What a map is asked for decides how soon it may be put away again.
  enum class Errand {
    visit,     ///< Somebody comes in.
    question,  ///< Something is asked about it, and that may be all.
  };
  /// The room of a map. It may be closed before the caller gets to its strand: then that is told
  /// with `let_go`, and the map asked for again. Fails with unknown_map, as a journal does, with
  /// not_supported for a format that cannot be read, and with shutting_down after `stop`.
  void open(const std::string& name, Errand errand, Opened done);
  /// This room was found closed: whoever asks from now on gets another one, once its journal is
  /// closed. On the room's strand.
  void let_go(const Room& closed);

  /// Takes the map out: says `bye` to its viewers, waits until its journal is closed and removes
  /// it. Fails with unknown_map; when it cannot be removed, as a journal does, and it is still
  /// there.
  void erase(const std::string& name, Erased done);

  struct MapName {
    std::string name;
    std::optional<std::uint64_t> epoch;  ///< Nothing as long as the map was not opened.
  };
  /// In alphabetic order. Opens nothing.
  [[nodiscard]] std::vector<MapName> list() const;
  /// Those that live now, in order of their names.
  [[nodiscard]] std::vector<std::shared_ptr<Room>> rooms() const;
  [[nodiscard]] Meters& meters() const;
  /// The same, for who may outlive the atlas.
  [[nodiscard]] std::shared_ptr<Meters> shared_meters() const;

  /// Closes all rooms once what they accepted is stored, opens none any more, and waits until
  /// every journal is closed. False when that took longer than `patience`. Their strands must be
  /// running, and the caller be on none of them. Nothing is run aside any more afterwards.
  [[nodiscard]] bool stop(std::chrono::milliseconds patience);

 private:
  class Core;
  std::shared_ptr<Core> core_;
};

}  // namespace earthwork::room
