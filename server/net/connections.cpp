#include "server/net/connections.hpp"

#include <utility>

namespace earthwork::net {

std::optional<Connections::Id> Connections::admit(std::size_t most) {
  const std::lock_guard lock(mutex_);
  if (stops_.size() >= most) return std::nullopt;
  stops_.emplace(++last_, [] {});
  return last_;
}

void Connections::on_stop(Id id, std::function<void()> stop) {
  const std::lock_guard lock(mutex_);
  if (stopping_) stop();
  stops_[id] = std::move(stop);
}

void Connections::remove(Id id) {
  const std::lock_guard lock(mutex_);
  stops_.erase(id);
  removed_.notify_all();
}

std::size_t Connections::count() const {
  const std::lock_guard lock(mutex_);
  return stops_.size();
}

void Connections::stop_all(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  stopping_ = true;
  for (const auto& [id, stop] : stops_) stop();
  removed_.wait_for(lock, patience, [this] { return stops_.empty(); });
}

}  // namespace earthwork::net
