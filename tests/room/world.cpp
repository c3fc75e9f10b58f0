#include "tests/room/world.hpp"

#include <stdexcept>
#include <utility>

namespace earthwork::room {
namespace {

void must(const protocol::Result<void>& result) {
  if (!result) throw std::runtime_error("refused: " + result.error().detail);
}

}  // namespace

World::World(protocol::MapSettings settings) {
  room = std::make_shared<Room>("m", std::move(settings), 0xABCD, context.make_strand(), meters);
}

World::Guest World::enter(const char* name, std::uint64_t author) {
  Guest guest;
  const std::uint64_t session = ++last_session;
  guest.author = author != 0 ? author : session;
  guest.id =
      room->join(guest.eyes, {protocol::hex(session), name, "#102030", protocol::hex(guest.author)})
          .value()
          .viewer;
  return guest;
}

void World::look(Guest& guest, const protocol::View& view) {
  must(room->look(guest.id, view));
  settle(guest);
}

protocol::Result<void> World::submit(Guest& guest, protocol::Edit edit) {
  return room->submit(guest.id, {++guest.last_message, guest.author, std::move(edit)});
}

void World::edit(Guest& guest, protocol::Edit edit) {
  must(submit(guest, std::move(edit)));
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

std::uint64_t World::mesh_hash() {
  while (!room->refresh_meshes(1000)) {
  }
  return room->meshes().mesh_hash;
}

}  // namespace earthwork::room
