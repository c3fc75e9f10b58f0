#include "tests/viewer/played_server.hpp"

#include <algorithm>
#include <utility>

#include "protocol/frame.hpp"

namespace earthwork::viewer {

using namespace std::chrono_literals;
using nlohmann::json;

namespace {

protocol::ChunkMesh square(std::int32_t voxels) {
  const std::int32_t side = voxels * 32768;
  return {.vertices = {{0, 0}, {side, 0}, {side, side}, {0, side}},
          .triangles = {0, 1, 2, 0, 2, 3},
          .sections = {{.a = 0, .b = 1, .normal_a = {0, -32767}, .normal_b = {0, -32767}}}};
}

}  // namespace

protocol::User user(const std::string& session, const std::string& name) {
  return {.session = session, .name = name, .color = "#aabbcc", .author = "00112233445566ff"};
}

protocol::MapSettings bounded() {
  protocol::MapSettings settings;
  settings.chunks = {-32, -32, 32, 32};
  return settings;
}

protocol::MapSettings layered(std::size_t layers) {
  protocol::MapSettings settings;
  settings.layers.resize(layers);
  return settings;
}

PlayedServer::PlayedServer(ViewerOptions options)
    : viewer(std::make_unique<Viewer>(shell, std::move(options), now)) {
  viewer->resize({800, 600}, 2, now);
}

ViewerOptions PlayedServer::default_options() {
  ViewerOptions options;
  options.map = "demo";
  options.hello.name = "Me";
  options.hello.color = "#112233";
  options.seed = 5;
  return options;
}

void PlayedServer::greet() {
  viewer->connected(now);
  say(protocol::Welcome{.session = kMe, .key = kKey, .protocol = 1, .id = {}});
}

void PlayedServer::join(const protocol::MapSettings& settings, const std::string& epoch,
                        std::uint64_t seq) {
  greet();
  say(protocol::Joined{.map = last("join")["map"],
                       .settings = settings,
                       .epoch = epoch,
                       .seq = seq,
                       .users = {user(kMe, "Me")},
                       .id = {}});
}

void PlayedServer::say(const protocol::ServerMessage& message) {
  viewer->text(protocol::write(message), now);
}

void PlayedServer::show(const std::vector<protocol::ChunkKey>& keys, std::uint64_t revision) {
  std::string message(protocol::records_head());
  for (const protocol::ChunkKey& key : keys)
    protocol::encode_record(
        {.key = key, .revision = revision, .removed = false, .mesh = square(32)}, message);
  binary(message);
}

void PlayedServer::binary(const std::string& message) {
  viewer->binary(std::as_bytes(std::span(message)), now);
}

void PlayedServer::catch_up(std::uint64_t seq) {
  say(protocol::CaughtUp{.n = last("view")["n"], .seq = seq});
}

void PlayedServer::await_connect() {
  for (const int before = shell.connects; shell.connects == before;) pass(1ms);
}

void PlayedServer::pass(std::chrono::milliseconds time) {
  const Time end = now + time;
  while (shell.wake_at && *shell.wake_at <= end) {
    now = std::max(now, *shell.wake_at);
    shell.wake_at.reset();
    viewer->tick(now);
  }
  now = end;
}

std::vector<json> PlayedServer::all(const std::string& type) const {
  std::vector<json> out;
  for (const std::string& text : shell.sent)
    if (json message = json::parse(text); message["type"] == type) out.push_back(message);
  return out;
}

json PlayedServer::last(const std::string& type) const {
  const auto said = all(type);
  return said.empty() ? json() : said.back();
}

void PlayedServer::mouse(PointerPhase phase, PointerButton button, double x, double y) {
  viewer->pointer({.phase = phase,
                   .kind = PointerKind::mouse,
                   .id = 1,
                   .button = button,
                   .at = {x, y},
                   .modifiers = {}},
                  now);
}

void PlayedServer::press(double x, double y) {
  mouse(PointerPhase::press, PointerButton::left, x, y);
}
void PlayedServer::drag(double x, double y) {
  mouse(PointerPhase::move, PointerButton::none, x, y);
}
void PlayedServer::hover(double x, double y) { drag(x, y); }
void PlayedServer::release(double x, double y) {
  mouse(PointerPhase::release, PointerButton::left, x, y);
}

void PlayedServer::leave() { mouse(PointerPhase::leave, PointerButton::none, 0, 0); }

bool PlayedServer::key(const std::string& key) {
  return viewer->key({.key = key, .modifiers = {}, .repeat = false}, now);
}

void PlayedServer::frame() {
  drawn = viewer->frame(now);
  frames_drawn_ = shell.frames_asked;
}

bool PlayedServer::draw_if_asked() {
  if (shell.frames_asked == frames_drawn_) return false;
  frame();
  return true;
}

}  // namespace earthwork::viewer
