#include "server/room/room_maker.hpp"

#include <exception>
#include <utility>

#include "server/journal/restore.hpp"
#include "server/room/entropy.hpp"
#include "server/room/opening.hpp"

namespace earthwork::room {

using protocol::Code;

RoomMaker::RoomMaker(std::function<std::unique_ptr<Strand>()> make_strand,
                     std::shared_ptr<journal::Shelf> shelf, std::shared_ptr<Meters> meters)
    : make_strand_(std::move(make_strand)), shelf_(std::move(shelf)), meters_(std::move(meters)) {}

// Whatever is thrown here, out of memory most likely, is this map's trouble alone.
RoomMaker::Made RoomMaker::make(const std::string& name,
                                const std::optional<protocol::MapSettings>& settings,
                                std::shared_ptr<ChatLog> chat, Lease::GiveBack give_back) {
  bool on_shelf = !settings;
  try {
    auto strand = make_strand_();
    auto journal = take(name, settings, *strand);
    if (!journal) {
      const Code code = journal.error().code;
      on_shelf = settings ? code == Code::map_exists : code != Code::unknown_map;
      return {tl::unexpected<protocol::Failure>(std::move(journal.error())), on_shelf};
    }
    on_shelf = true;
    return {furnish(name, std::move(*journal), std::move(strand), std::move(chat),
                    std::move(give_back))};
  } catch (const std::exception& error) {
    return {protocol::fail(Code::internal, std::string("map: ") + error.what(), "map"), on_shelf};
  }
}

RoomMaker::NewJournal RoomMaker::take(const std::string& name,
                                      const std::optional<protocol::MapSettings>& settings,
                                      const Strand& strand) {
  if (!settings) return shelf_->open(name);
  return shelf_->create(
      name, {.settings = *settings, .epoch = random_u64(), .created_ms = strand.now_ms()});
}

protocol::Result<RoomMaker::Furnished> RoomMaker::furnish(const std::string& name,
                                                          std::unique_ptr<journal::Journal> journal,
                                                          std::unique_ptr<Strand> strand,
                                                          std::shared_ptr<ChatLog> chat,
                                                          Lease::GiveBack give_back) {
  journal::Identity identity = journal->identity();
  auto restored = journal::restore(*journal, {}, journal::Trust::strict);
  if (!restored) return tl::unexpected<protocol::Failure>(std::move(restored.error()));
  auto clerk = shelf_->hire(std::move(journal));
  if (!clerk) return tl::unexpected<protocol::Failure>(std::move(clerk.error()));
  // The shelf, and with it the lock on its folder, stays until the last journal is closed.
  auto hand_on = [shelf = shelf_, give_back = std::move(give_back)](
                     std::unique_ptr<journal::Clerk> done) { give_back(std::move(done)); };
  const auto lease = std::make_shared<Lease>(std::move(*clerk), std::move(hand_on));
  Opening opening{.identity = std::move(identity),
                  .restored = std::move(*restored),
                  .clerk = std::make_unique<LeasedClerk>(lease),
                  .commits = shelf_->kept() ? Commits::later : Commits::at_once,
                  .chat = std::move(chat)};
  return Furnished{std::make_shared<Room>(name, std::move(opening), std::move(strand), meters_),
                   lease};
}

}  // namespace earthwork::room
