#include "client/viewer/viewer.hpp"

#include <utility>

#include "client/viewer/viewer_state.hpp"

namespace earthwork::viewer {

Viewer::Viewer(Shell& shell, ViewerOptions options, Time now)
    : state_(std::make_unique<State>(shell, std::move(options), now)) {
  state_->settle();
}

Viewer::~Viewer() = default;

void Viewer::connected(Time now) {
  state_->now = now;
  state_->session.connected(now);
  state_->settle();
}

void Viewer::text(std::string_view message, Time now) {
  state_->now = now;
  state_->session.text(message, now);
  state_->settle();
}

void Viewer::binary(std::span<const std::byte> message, Time now) {
  state_->now = now;
  state_->session.binary(message, now);
  state_->settle();
}

void Viewer::disconnected(int code, std::string_view reason, Time now) {
  state_->now = now;
  state_->session.disconnected(code, reason, now);
  state_->settle();
}

void Viewer::resize(scene::ScreenSize size, double pixel_ratio, Time now) {
  state_->now = now;
  state_->resize(size, pixel_ratio);
  state_->settle();
}

void Viewer::pointer(const PointerEvent& event, Time now) {
  state_->now = now;
  state_->take_pointer(event);
  state_->settle();
}

void Viewer::wheel(const WheelEvent& event, Time now) {
  state_->now = now;
  state_->take_wheel(event);
  state_->settle();
}

bool Viewer::key(const KeyEvent& event, Time now) {
  const auto shortcut = shortcut_of(event);
  if (!shortcut) return false;
  state_->now = now;
  state_->run(*shortcut);
  state_->settle();
  return true;
}

void Viewer::hold_space(bool held) { state_->hand.set_space(held); }

protocol::Result<void> Viewer::command(const PanelCommand& command, Time now) {
  state_->now = now;
  auto done = std::visit([&](const auto& what) { return state_->run(what); }, command);
  state_->settle();
  return done;
}

void Viewer::tick(Time now) {
  state_->now = now;
  state_->woken_at.reset();
  state_->session.tick(now);
  state_->painter.flush(now);
  state_->settle();
}

Viewer::Frame Viewer::frame(Time now) {
  state_->now = now;
  Frame frame = state_->frame();
  state_->settle();
  return frame;
}

void Viewer::drawn(const Time& began, const Time& ended, std::size_t triangles) {
  static_cast<void>(began);
  state_->meter.drawn(ended, triangles);
}

const scene::Scene& Viewer::scene() const { return state_->meshes; }

PanelChanges Viewer::panels(Time now) {
  state_->now = now;
  PanelChanges changes = state_->panels();
  state_->settle();
  return changes;
}

std::vector<Label> Viewer::labels() const { return state_->labels(); }

}  // namespace earthwork::viewer
