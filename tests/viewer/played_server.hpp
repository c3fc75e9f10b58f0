/// A viewer at a server that the test plays: time stands still unless the test moves it.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "client/viewer/viewer.hpp"
#include "protocol/chunk_record.hpp"
#include "protocol/messages.hpp"
#include "tests/viewer/fake_shell.hpp"

namespace earthwork::viewer {

inline const std::string kEpoch = "00000000000000aa", kOtherEpoch = "00000000000000bb";
inline const std::string kKey = "0123456789abcdef0123456789abcdef";
inline const std::string kMe = "00000000000000e1", kAnn = "00000000000000a1",
                         kBob = "00000000000000b1";

[[nodiscard]] protocol::User user(const std::string& session, const std::string& name);
/// 64 x 64 chunks of 32 voxels around 0.
[[nodiscard]] protocol::MapSettings bounded();
[[nodiscard]] protocol::MapSettings layered(std::size_t layers);

class PlayedServer {
 public:
  using Time = Viewer::Time;

  /// On a screen of 800 x 600, and not connected yet.
  explicit PlayedServer(ViewerOptions options = default_options());
  static ViewerOptions default_options();

  /// The socket opens, and hello and join are answered.
  void join(const protocol::MapSettings& settings = {}, const std::string& epoch = kEpoch,
            std::uint64_t seq = 1);
  /// The socket opens and hello is answered.
  void greet();
  void say(const protocol::ServerMessage& message);
  /// Squares that fill these chunks, outside a group.
  void show(const std::vector<protocol::ChunkKey>& keys, std::uint64_t revision = 1);
  void binary(const std::string& message);
  /// All of the view that was asked for last has come.
  void catch_up(std::uint64_t seq = 1);
  void cut() { viewer->disconnected(1006, "", now); }
  /// Time goes on until the viewer, whose connection was lost, tries another one.
  void await_connect();
  /// Time goes on, and the viewer is woken when it asked to be.
  void pass(std::chrono::milliseconds time);

  [[nodiscard]] nlohmann::json last(const std::string& type) const;
  [[nodiscard]] std::vector<nlohmann::json> all(const std::string& type) const;
  [[nodiscard]] std::size_t count(const std::string& type) const { return all(type).size(); }

  /// A mouse at that place of the screen.
  void press(double x, double y);
  void drag(double x, double y);
  void hover(double x, double y);
  void release(double x, double y);
  void leave();
  bool key(const std::string& key);
  void frame();
  /// Draws if the viewer wants to be drawn; whether it did.
  bool draw_if_asked();

  FakeShell shell;
  Time& now = shell.now;
  std::unique_ptr<Viewer> viewer;
  Viewer::Frame drawn;  ///< The last one.

 private:
  void mouse(PointerPhase phase, PointerButton button, double x, double y);

  int frames_drawn_ = 0;  // as of shell.frames_asked
};

}  // namespace earthwork::viewer
