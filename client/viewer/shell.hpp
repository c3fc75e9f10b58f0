/// What a viewer needs of the program around it: a socket, another frame, a wake-up.
#pragma once

#include <chrono>
#include <string_view>

namespace earthwork::viewer {

/// Nothing calls back into the viewer from within these calls.
class Shell {
 public:
  virtual ~Shell() = default;

  /// Opens the WebSocket to the server. Then `Viewer::connected`, or `disconnected`, follows.
  virtual void connect() = 0;
  /// Sends a text message over the open socket.
  virtual void send(std::string_view text) = 0;
  /// Closes the socket, if there is one; `disconnected` does not follow.
  virtual void disconnect() = 0;
  /// Something is to be drawn: calls `Viewer::frame` before the next picture, once.
  virtual void ask_frame() = 0;
  /// Calls `Viewer::tick` after that time; a later call replaces an earlier one.
  virtual void wake_after(std::chrono::milliseconds delay) = 0;
};

}  // namespace earthwork::viewer
