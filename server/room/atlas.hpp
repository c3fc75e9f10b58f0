/// All live maps of a server, by name.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/result.hpp"
#include "protocol/settings.hpp"
#include "server/room/room.hpp"

namespace earthwork::room {

inline constexpr std::size_t kMaxMaps = 4096;

/// Any thread.
class Atlas {
 public:
  /// `make_strand` is called for each new room, from any thread. All rooms count in `meters`.
  explicit Atlas(std::function<std::unique_ptr<Strand>()> make_strand,
                 std::shared_ptr<Meters> meters = std::make_shared<Meters>());

  /// A new, empty map. `settings` is valid. Fails with bad_name, with map_exists, and with
  /// too_large when there are kMaxMaps.
  [[nodiscard]] protocol::Result<std::shared_ptr<Room>> create(
      const std::string& name, const protocol::MapSettings& settings);
  /// Null when there is none.
  [[nodiscard]] std::shared_ptr<Room> find(std::string_view name) const;
  /// In alphabetic order.
  [[nodiscard]] std::vector<std::shared_ptr<Room>> list() const;
  /// Takes the map out and says `bye` to its viewers; false when there is none.
  bool erase(std::string_view name);
  [[nodiscard]] Meters& meters() const { return *meters_; }

 private:
  std::function<std::unique_ptr<Strand>()> make_strand_;
  std::shared_ptr<Meters> meters_;
  mutable std::mutex mutex_;
  std::map<std::string, std::shared_ptr<Room>, std::less<>> rooms_;
};

}  // namespace earthwork::room
