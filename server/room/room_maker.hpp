/// From what lies on a shelf to a room.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "protocol/result.hpp"
#include "protocol/settings.hpp"
#include "server/journal/shelf.hpp"
#include "server/room/leased_clerk.hpp"
#include "server/room/room.hpp"

namespace earthwork::room {

/// Any thread, for one name from one thread at a time; takes as long as the shelf, and a start from
/// the stored map.
class RoomMaker {
 public:
  RoomMaker(std::function<std::unique_ptr<Strand>()> make_strand,
            std::shared_ptr<journal::Shelf> shelf, std::shared_ptr<Meters> meters);

  struct Furnished {
    std::shared_ptr<Room> room;
    std::shared_ptr<Lease> lease;  ///< Of its clerk.
  };
  struct Made {
    protocol::Result<Furnished> map;
    bool on_shelf = true;  ///< Whether there is such a map now, be it one that cannot be opened.
  };
  /// A new map with `settings`, or one that is there, whose talk is kept in `chat`. `give_back` is
  /// called with the room's clerk when the lease ends, as it does with the room at the latest.
  [[nodiscard]] Made make(const std::string& name,
                          const std::optional<protocol::MapSettings>& settings,
                          std::shared_ptr<ChatLog> chat, Lease::GiveBack give_back);

 private:
  using NewJournal = protocol::Result<std::unique_ptr<journal::Journal>>;
  [[nodiscard]] NewJournal take(const std::string& name,
                                const std::optional<protocol::MapSettings>& settings,
                                const Strand& strand);
  [[nodiscard]] protocol::Result<Furnished> furnish(const std::string& name,
                                                    std::unique_ptr<journal::Journal> journal,
                                                    std::unique_ptr<Strand> strand,
                                                    std::shared_ptr<ChatLog> chat,
                                                    Lease::GiveBack give_back);

  std::function<std::unique_ptr<Strand>()> make_strand_;
  std::shared_ptr<journal::Shelf> shelf_;
  std::shared_ptr<Meters> meters_;
};

}  // namespace earthwork::room
