/// The open connections of a server, so that they can be counted and told to end.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>

namespace earthwork::net {

/// Any thread.
class Connections {
 public:
  using Id = std::uint64_t;

  /// Lists one more, unless `most` are listed already.
  [[nodiscard]] std::optional<Id> admit(std::size_t most);
  /// How the connection is told to end, from now on: also when an HTTP one became a session. `stop`
  /// must be callable from any thread as long as the connection is listed.
  void on_stop(Id id, std::function<void()> stop);
  void remove(Id id);
  [[nodiscard]] std::size_t count() const;

  /// Tells all to end; those that come later at once. Then waits until none is left, or for
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
