#include "client/viewer/web/page.hpp"

#include <emscripten.h>
#include <emscripten/heap.h>
#include <emscripten/html5.h>

#include <utility>

#include "client/viewer/web/hooks.hpp"

namespace earthwork::viewer {
namespace {

using protocol::Result;

Viewer::Time now() { return std::chrono::steady_clock::now(); }

bool any(const PanelChanges& changes) {
  return changes.connection || changes.map || changes.brush || changes.people || changes.chat ||
         changes.status || changes.camera || changes.notices;
}

std::vector<protocol::ChunkKey> keys_of(const scene::Scene::Chunks& chunks) {
  std::vector<protocol::ChunkKey> keys;
  keys.reserve(chunks.size());
  for (const auto& [key, chunk] : chunks) keys.push_back(key);
  return keys;
}

}  // namespace

Result<std::unique_ptr<Page>> Page::open(ViewerOptions options) {
  std::unique_ptr<Page> page(new Page);
  if (auto started = page->start(std::move(options)); !started)
    return tl::unexpected<protocol::Failure>(std::move(started.error()));
  return page;
}

Result<void> Page::start(ViewerOptions options) {
  if (!Socket::has_server())
    return protocol::fail(protocol::Code::not_supported, "This page was not opened from a server.");
  if (auto opened = canvas_.open(); !opened) return opened;
  auto renderer = Renderer::make();
  if (!renderer) return tl::unexpected<protocol::Failure>(std::move(renderer.error()));
  renderer_ = std::move(*renderer);
  Shell& shell = *this;
  viewer_ = std::make_unique<Viewer>(shell, std::move(options), now());
  canvas_.watch();
  listen_to_input(*this);
  return {};
}

Result<void> Page::command(std::string_view json) {
  const auto asked = read_panel_command(json);
  if (!asked) return tl::unexpected<protocol::Failure>(asked.error());
  auto done = viewer_->command(*asked, now());
  show_panels();
  return done;
}

// Without a context the viewer is not asked for a frame: it would count as drawn. It is asked when
// there is one again.
void Page::draw() {
  if (frame_request_ != 0) emscripten_cancel_animation_frame(frame_request_);
  frame_request_ = 0;
  if (!renderer_) return;

  const auto began = now();
  const double began_ms = emscripten_get_now();
  const Viewer::Frame frame = viewer_->frame(began);
  const scene::Scene& scene = viewer_->scene();
  if (frame.all) renderer_->clear();
  renderer_->update(scene.chunks(), frame.changed, frame.picture.settings);
  const DrawCounts counts = renderer_->draw(frame.picture);
  viewer_->drawn(began, now(), counts.triangles);
  figures_.draw({.began_ms = began_ms,
                 .ended_ms = emscripten_get_now(),
                 .meshes_changed = frame.all || !frame.changed.empty(),
                 .whole = scene.complete_view().has_value(),
                 .triangles = counts.triangles,
                 .draws = counts.draws});
  show_labels();
  show_panels();
}

std::string Page::figures() const { return figures_.write(emscripten_get_heap_size()); }

void Page::connect() { socket_.open(); }
void Page::send(std::string_view text) { socket_.send(text); }
void Page::disconnect() { socket_.close(); }

void Page::ask_frame() {
  if (frame_request_ != 0) return;
  const auto draw_it = [](double, void* page) -> EM_BOOL {
    static_cast<Page*>(page)->frame_request_ = 0;
    static_cast<Page*>(page)->draw();
    return EM_FALSE;
  };
  frame_request_ = emscripten_request_animation_frame(draw_it, this);
}

void Page::wake_after(std::chrono::milliseconds delay) {
  if (wake_request_ != 0) emscripten_clear_timeout(wake_request_);
  wake_request_ = emscripten_set_timeout([](void* page) { static_cast<Page*>(page)->wake(); },
                                         static_cast<double>(delay.count()), this);
}

void Page::wake() {
  wake_request_ = 0;
  viewer_->tick(now());
  show_panels();
}

void Page::socket_opened() {
  viewer_->connected(now());
  show_panels();
}

void Page::socket_told(std::string_view text) {
  viewer_->text(text, now());
  show_panels();
}

void Page::socket_told(std::span<const std::byte> message) {
  viewer_->binary(message, now());
  show_panels();
}

void Page::socket_closed(int code, std::string_view reason) {
  viewer_->disconnected(code, reason, now());
  show_panels();
}

// At once: the canvas is empty until it is drawn again, and would be seen so.
void Page::canvas_resized(scene::ScreenSize size, double pixel_ratio) {
  viewer_->resize(size, pixel_ratio, now());
  draw();
}

void Page::canvas_lost() { renderer_.reset(); }

void Page::canvas_restored() {
  auto renderer = Renderer::make();
  if (!renderer) return;
  renderer_ = std::move(*renderer);
  // Before the frame, which tells only what is new since the last one.
  const Viewer::Frame frame = viewer_->frame(now());
  const scene::Scene::Chunks& chunks = viewer_->scene().chunks();
  renderer_->update(chunks, keys_of(chunks), frame.picture.settings);
  draw();
}

void Page::pointed(const PointerEvent& event, bool last) {
  if (event.phase == PointerPhase::press) figures_.press(emscripten_get_now());
  viewer_->pointer(event, now());
  if (last) show_panels();
}

void Page::wheeled(const WheelEvent& event) {
  viewer_->wheel(event, now());
  show_panels();
}

void Page::space_held(bool held) { viewer_->hold_space(held); }

bool Page::key_pressed(const KeyEvent& event) {
  const bool meant = viewer_->key(event, now());
  show_panels();
  return meant;
}

// The page may answer with a command, which comes back to here: nothing is kept across the call.
void Page::show_panels() {
  const PanelChanges changes = viewer_->panels(now());
  if (any(changes)) tell_panels(write(changes));
}

void Page::show_labels() {
  std::vector<Label> labels = viewer_->labels();
  if (labels == labels_) return;
  labels_ = std::move(labels);
  tell_labels(write(labels_));
}

}  // namespace earthwork::viewer
