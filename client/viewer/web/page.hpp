/// The viewer in a browser's page: the shell around it, its canvas, its socket, and what people do.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "client/viewer/render/renderer.hpp"
#include "client/viewer/shell.hpp"
#include "client/viewer/viewer.hpp"
#include "client/viewer/web/canvas.hpp"
#include "client/viewer/web/figures.hpp"
#include "client/viewer/web/input_source.hpp"
#include "client/viewer/web/socket.hpp"

namespace earthwork::viewer {

/// One for as long as the page is open, on the page's only thread. Pictures are drawn when the
/// viewer asks for one or the canvas is laid out anew, and else never.
class Page final : Shell, SocketListener, CanvasListener, InputListener {
 public:
  /// Connects to the server, and draws. Fails with not_supported where the browser cannot draw or
  /// the page came from no server.
  [[nodiscard]] static protocol::Result<std::unique_ptr<Page>> open(ViewerOptions options);
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;

  [[nodiscard]] protocol::Result<void> command(std::string_view json);
  /// Now, so that the canvas can be read in the same task of the browser.
  void draw();
  /// As of Figures.
  [[nodiscard]] std::string figures() const;

 private:
  Page() : canvas_(*this), socket_(*this) {}
  protocol::Result<void> start(ViewerOptions options);

  void connect() override;
  void send(std::string_view text) override;
  void disconnect() override;
  void ask_frame() override;
  void wake_after(std::chrono::milliseconds delay) override;

  void socket_opened() override;
  void socket_told(std::string_view text) override;
  void socket_told(std::span<const std::byte> message) override;
  void socket_closed(int code, std::string_view reason) override;

  void canvas_resized(scene::ScreenSize size, double pixel_ratio) override;
  void canvas_lost() override;
  void canvas_restored() override;

  void pointed(const PointerEvent& event, bool last) override;
  void wheeled(const WheelEvent& event) override;
  bool key_pressed(const KeyEvent& event) override;
  void space_held(bool held) override;

  void wake();
  void show_panels();
  void show_labels();

  Canvas canvas_;
  Socket socket_;
  std::unique_ptr<Renderer> renderer_;  // none while the context is lost
  std::unique_ptr<Viewer> viewer_;
  Figures figures_;
  std::vector<Label> labels_;  // that the page shows
  long frame_request_ = 0;     // 0: none is asked for
  long wake_request_ = 0;      // 0: none
};

}  // namespace earthwork::viewer
