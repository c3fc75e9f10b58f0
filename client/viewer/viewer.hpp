/// A person at a map, whatever the program around: what they see, do, and are told.
///
/// A window or a page hands it what happens - messages, pointers, keys, commands of panels - and
/// draws what it answers with. Nothing in here knows OpenGL, a browser or a toolkit.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "client/scene/brush.hpp"
#include "client/scene/camera.hpp"
#include "client/scene/scene.hpp"
#include "client/viewer/input.hpp"
#include "client/viewer/panel_command.hpp"
#include "client/viewer/panel_state.hpp"
#include "client/viewer/picture.hpp"
#include "client/viewer/shell.hpp"
#include "protocol/messages.hpp"

namespace earthwork::viewer {

struct ViewerOptions {
  std::string map;
  protocol::Hello hello;          ///< Name, colour; the key of an earlier time.
  protocol::MessageId last_id{};  ///< The largest that was ever used with that key in this map.
  std::uint64_t seed = 0;         ///< Of the delays between attempts to connect.
  std::optional<scene::Camera::Place> place;  ///< None: all of the map, as soon as it is known.
};

/// One thread. `now` never goes back.
class Viewer {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Connects. `shell` outlives it.
  Viewer(Shell& shell, ViewerOptions options, Time now);
  ~Viewer();

  void connected(Time now);
  void text(std::string_view message, Time now);
  void binary(std::span<const std::byte> message, Time now);
  /// With the code and reason of the close; 1006 when there was none.
  void disconnected(int code, std::string_view reason, Time now);

  void resize(scene::ScreenSize size, double pixel_ratio, Time now);
  void pointer(const PointerEvent& event, Time now);
  void wheel(const WheelEvent& event, Time now);
  /// A key went down while no text field had it. False when it means nothing here.
  bool key(const KeyEvent& event, Time now);
  /// Space was pressed (true) or released: a drag that begins while it is held moves the map.
  void hold_space(bool held);
  /// Fails with what the panel is to say: a field and its bound.
  [[nodiscard]] protocol::Result<void> command(const PanelCommand& command, Time now);
  void tick(Time now);

  /// What is to be drawn now. `changed` are the chunks that are new, different or gone since the
  /// last frame; `all` says that everything before is gone.
  struct Frame {
    Picture picture;
    std::vector<protocol::ChunkKey> changed;
    bool all = false;
  };
  [[nodiscard]] Frame frame(Time now);
  /// How long it took to draw: for the figures.
  void drawn(const Time& began, const Time& ended, std::size_t triangles);
  [[nodiscard]] const scene::Scene& scene() const;

  /// What the panels show: those parts that changed since the last call.
  [[nodiscard]] PanelChanges panels(Time now);
  /// Names beside cursors and words beside places, where they are on the screen as of the last
  /// frame.
  [[nodiscard]] std::vector<Label> labels() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace earthwork::viewer
