#include "server/room/settings_book.hpp"

#include <utility>

namespace earthwork::room {

SettingsBook::SettingsBook(protocol::MapSettings settings)
    : accepted_(std::move(settings)),
      durable_(std::make_shared<const protocol::MapSettings>(accepted_)) {}

std::shared_ptr<const protocol::MapSettings> SettingsBook::durable() const {
  const std::lock_guard lock(mutex_);
  return durable_;
}

// A batch of edits alone, as most are, costs a look at each.
std::uint64_t SettingsBook::store(std::span<const history::Event> events) {
  std::uint64_t last = 0;
  std::shared_ptr<protocol::MapSettings> stored;
  for (const history::Event& event : events) {
    const auto* change = std::get_if<protocol::LayerChange>(&event.action);
    if (!change) continue;
    if (!stored) stored = std::make_shared<protocol::MapSettings>(*durable_);
    protocol::apply(*change, *stored);
    last = event.seq;
  }
  if (!stored) return 0;
  const std::lock_guard lock(mutex_);
  durable_ = std::move(stored);
  return last;
}

}  // namespace earthwork::room
