/// A map's settings, which change with its layers: as the map has them, and as anybody may know
/// them.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>

#include "protocol/layer_change.hpp"
#include "protocol/settings.hpp"
#include "server/history/event.hpp"

namespace earthwork::room {

/// On the strand of the room whose part it is, apart from `durable`.
class SettingsBook {
 public:
  /// These are durable.
  explicit SettingsBook(protocol::MapSettings settings);

  /// With every change that was accepted.
  [[nodiscard]] const protocol::MapSettings& accepted() const { return accepted_; }
  /// As of the last event that is stored. Any thread.
  [[nodiscard]] std::shared_ptr<const protocol::MapSettings> durable() const;

  void accept(const protocol::LayerChange& change) { protocol::apply(change, accepted_); }
  /// These events are stored now. Gives back the seq of the last one that changed the settings; 0
  /// when none did.
  std::uint64_t store(std::span<const history::Event> events);
  /// What is not stored never will be.
  void take_back() { accepted_ = *durable_; }

 private:
  protocol::MapSettings accepted_;
  mutable std::mutex mutex_;  // of durable_, which the strand alone writes
  std::shared_ptr<const protocol::MapSettings> durable_;
};

}  // namespace earthwork::room
