#include "tests/room/world.hpp"

#include <limits>
#include <stdexcept>
#include <utility>

#include "server/journal/memory_journal.hpp"

namespace earthwork::room {
namespace {

void must(const protocol::Result<void>& result) {
  if (!result) throw std::runtime_error("refused: " + result.error().detail);
}

}  // namespace

journal::Identity identity_of(const protocol::MapSettings& settings) {
  return {.settings = settings, .epoch = 0xABCD, .created_ms = 0};
}

World::World(const protocol::MapSettings& settings) {
  auto in_memory = journal::make_memory_journal(identity_of(settings));
  journal = in_memory.get();
  auto clerk = journal::immediate_clerk(std::move(in_memory));
  room = std::make_shared<Room>(
      "m", open_empty(identity_of(settings), std::move(clerk), Commits::at_once),
      context.make_strand(), meters);
}

World::World(Opening opening, journal::Journal& its_journal)
    : room(std::make_shared<Room>("m", std::move(opening), context.make_strand(), meters)),
      journal(&its_journal) {}

World::Guest World::enter(const char* name, std::uint64_t author) {
  Guest guest;
  const std::uint64_t session = ++last_session;
  guest.author = author != 0 ? author : session;
  const auto entrance =
      room->join(guest.eyes, {protocol::hex(session), name, "#102030", protocol::hex(guest.author)})
          .value();
  guest.id = entrance.viewer;
  guest.eyes->known_layers = entrance.joined.settings.layers.size();
  return guest;
}

void World::look(Guest& guest, const protocol::View& view) {
  must(room->look(guest.id, view));
  settle(guest);
}

protocol::Result<void> World::submit(Guest& guest, protocol::Action action) {
  return room->submit(guest.id, {++guest.last_message, guest.author, std::move(action)});
}

void World::edit(Guest& guest, protocol::Action action) {
  must(submit(guest, std::move(action)));
  context.run();
}

void World::settle(Guest& guest) {
  context.run();
  for (std::size_t taken = SIZE_MAX; taken != guest.eyes->parcels.size();) {
    taken = guest.eyes->parcels.size();
    room->ready(guest.id);
    context.run();
  }
}

std::vector<history::Event> World::events() {
  return journal->events(1, std::numeric_limits<std::size_t>::max()).value();
}

std::uint64_t World::mesh_hash() {
  while (!room->refresh_meshes(1000)) {
  }
  return room->meshes().mesh_hash;
}

}  // namespace earthwork::room
