/// The open connections of a server, so that they can be counted and told to end.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>

namespace earthwork::net {

/// Any thread.
class Connections {
 public:
  using Id = std::uint64_t;

  /// `stop` must be callable from any thread as long as the connection is listed.
  Id add(std::function<void()> stop);
  /// The connection is another thing now: an HTTP one became a session.
  void replace(Id id, std::function<void()> stop);
  void remove(Id id);
  [[nodiscard]] std::size_t count() const;

  /// Tells all to end; those that are added later at once. Then waits until none is left, or for
  /// `patience`.
  void stop_all(std::chrono::milliseconds patience);

 private:
  mutable std::mutex mutex_;
  std::condition_variable removed_;
  std::map<Id, std::function<void()>> stops_;
  Id last_ = 0;
  bool stopping_ = false;
};

}  // namespace earthwork::net
