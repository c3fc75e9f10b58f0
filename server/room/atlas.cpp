#include "server/room/atlas.hpp"

#include <utility>

#include "server/room/entropy.hpp"

namespace earthwork::room {

using protocol::Code;

Atlas::Atlas(std::function<std::unique_ptr<Strand>()> make_strand, std::shared_ptr<Meters> meters)
    : make_strand_(std::move(make_strand)), meters_(std::move(meters)) {}

protocol::Result<std::shared_ptr<Room>> Atlas::create(const std::string& name,
                                                      const protocol::MapSettings& settings) {
  if (!protocol::valid_map_name(name))
    return protocol::fail(Code::bad_name, "name: 1 to 64 of a-z, 0-9, '-', '_'", "name");
  const std::lock_guard lock(mutex_);
  if (rooms_.contains(name))
    return protocol::fail(Code::map_exists, "name: there is a map named " + name, "name");
  if (rooms_.size() >= kMaxMaps)
    return protocol::fail(Code::too_large,
                          "the server has " + std::to_string(kMaxMaps) + " maps, its most");
  auto room = std::make_shared<Room>(name, settings, random_u64(), make_strand_(), meters_);
  rooms_.emplace(name, room);
  return room;
}

std::shared_ptr<Room> Atlas::find(std::string_view name) const {
  const std::lock_guard lock(mutex_);
  const auto found = rooms_.find(name);
  return found == rooms_.end() ? nullptr : found->second;
}

std::vector<std::shared_ptr<Room>> Atlas::list() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::shared_ptr<Room>> rooms;
  rooms.reserve(rooms_.size());
  for (const auto& [name, room] : rooms_) rooms.push_back(room);
  return rooms;
}

bool Atlas::erase(std::string_view name) {
  std::shared_ptr<Room> room;
  {
    const std::lock_guard lock(mutex_);
    const auto found = rooms_.find(name);
    if (found == rooms_.end()) return false;
    room = std::move(found->second);
    rooms_.erase(found);
  }
  room->strand().post([room] {
    room->close(
        {.failure = {Code::unknown_map, "the map was deleted", "map"}, .retry_after_ms = {}});
  });
  return true;
}

}  // namespace earthwork::room
