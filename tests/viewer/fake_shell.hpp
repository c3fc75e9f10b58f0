/// The program around a viewer, as tests have it: it does nothing and remembers what was asked.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "client/viewer/shell.hpp"

namespace earthwork::viewer {

class FakeShell final : public Shell {
 public:
  void connect() override { ++connects; }
  void send(std::string_view text) override { sent.emplace_back(text); }
  void disconnect() override { ++disconnects; }
  void ask_frame() override { ++frames_asked; }
  void wake_after(std::chrono::milliseconds delay) override { wake_at = now + delay; }

  std::chrono::steady_clock::time_point now{};  ///< Moved by the test.
  int connects = 0, disconnects = 0, frames_asked = 0;
  std::vector<std::string> sent;  ///< Over all connections.
  std::optional<std::chrono::steady_clock::time_point> wake_at;
};

}  // namespace earthwork::viewer
