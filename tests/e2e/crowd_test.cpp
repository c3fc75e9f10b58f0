// Eight editors at once: whatever the order the server gives their edits, the map is what that
// order makes of an empty one, and a viewer's mesh is the map's.
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <random>
#include <vector>

#include "client/link/event_loop.hpp"
#include "client/link/link.hpp"
#include "client/link/maps.hpp"
#include "client/scene/scene.hpp"
#include "server/history/fold.hpp"
#include "tests/e2e/server_answers.hpp"

namespace earthwork::e2e {
namespace {

constexpr int kEditors = 8;
constexpr int kEditsEach = 1000;
constexpr std::size_t kWindow = 32;

std::vector<protocol::Edit> random_edits(unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(random);
  };
  std::vector<protocol::Edit> out(kEditsEach);
  for (protocol::Edit& edit : out) {
    edit.stencil = between(0, 1) ? protocol::StencilShape::circle : protocol::StencilShape::square;
    edit.fill = between(0, 2) != 0;
    edit.radius = between(0, 80) / 16.0;
    edit.is_path = between(0, 3) == 0;
    for (int points = edit.is_path ? between(1, 5) : 1; points > 0; --points)
      edit.path.push_back({between(-800, 800) / 16.0, between(-800, 800) / 16.0});
  }
  return out;
}

using Order = std::map<std::uint64_t, protocol::Edit>;  // by seq

/// Sends its edits, at most kWindow of them unanswered, and enters each into the order.
class Editor {
 public:
  Editor(link::EventLoop& loop, const ServerProgram& server, unsigned seed, Order& order)
      : edits_(random_edits(seed)),
        order_(order),
        link_(loop, {.server = server.address(), .hello = hello(), .map = "crowd"},
              {.ready = [this] { send(); },
               .message = [this](const auto& message) { take(message); },
               .frame = {},
               .closed = [this](const link::Closing& closing) { closed_ = closing.cause; }}) {}

  bool done() const { return answered_ == edits_.size(); }

 private:
  static protocol::Hello hello() {
    protocol::Hello out;
    out.name = "editor";
    return out;
  }
  void send() {
    for (; sent_ < edits_.size() && sent_ - answered_ < kWindow; ++sent_) {
      const auto id = static_cast<protocol::MessageId>(sent_ + 1);
      ASSERT_TRUE(link_.send(protocol::EditMessage{.id = id, .edit = edits_[sent_]}));
    }
  }
  void take(const protocol::ServerMessage& message) {
    const auto* applied = std::get_if<protocol::Applied>(&message);
    if (!applied) return;
    const auto index = static_cast<std::size_t>(applied->id - 1);
    EXPECT_TRUE(order_.emplace(applied->seq, edits_[index]).second) << applied->seq;
    ++answered_;
    send();
    if (done()) link_.close();
  }

  std::vector<protocol::Edit> edits_;
  Order& order_;
  std::size_t sent_ = 0, answered_ = 0;
  link::CloseCause closed_ = link::CloseCause::asked;
  link::Link link_;
};

/// Views everything until it shows an event.
class Onlooker {
 public:
  Onlooker(link::EventLoop& loop, const ServerProgram& server, std::uint64_t until)
      : until_(until),
        link_(loop, {.server = server.address(), .hello = hello(), .map = "crowd"},
              {.ready =
                   [this] {
                     EXPECT_TRUE(
                         link_.send(protocol::View{.n = 1, .rect = {}, .have = {}, .id = {}}));
                   },
               .message =
                   [this](const auto& message) {
                     if (const auto* joined = std::get_if<protocol::Joined>(&message))
                       scene_.join(protocol::parse_hex(joined->epoch).value(), joined->seq);
                     if (const auto* said = std::get_if<protocol::CaughtUp>(&message))
                       scene_.catch_up(said->n, said->seq);
                     close_when_done();
                   },
               .frame =
                   [this](auto& events, std::size_t bytes) {
                     const auto taken = scene_.take(events, bytes);
                     EXPECT_TRUE(taken) << taken.error().detail;
                     close_when_done();
                   },
               .closed = {}}) {}
  const scene::Scene& scene() const { return scene_; }

 private:
  static protocol::Hello hello() {
    protocol::Hello out;
    out.name = "onlooker";
    return out;
  }
  void close_when_done() {
    if (scene_.complete_view() && scene_.seq() >= until_) link_.close();
  }

  std::uint64_t until_;
  scene::Scene scene_;
  link::Link link_;
};

TEST(Crowd, LeavesTheMapThatTheServersOrderMakes) {
  const ServerProgram server;
  protocol::MapSettings settings;
  settings.chunk_resolution = 16;
  ASSERT_TRUE(link::create_map(server.address(), "crowd", settings));

  link::EventLoop loop;
  Order order;
  Onlooker onlooker(loop, server, kEditors * kEditsEach);
  std::vector<std::unique_ptr<Editor>> editors;
  for (unsigned i = 0; i < kEditors; ++i)
    editors.push_back(std::make_unique<Editor>(loop, server, i + 1, order));
  loop.run();  // until every link has closed

  for (const auto& editor : editors) EXPECT_TRUE(editor->done());
  ASSERT_EQ(order.size(), 8000u);
  EXPECT_EQ(order.begin()->first, 1u);
  EXPECT_EQ(order.rbegin()->first, 8000u);
  voxel::Map map = history::make_map(settings);
  for (const auto& [seq, edit] : order) history::apply(map, edit);

  const auto live = figures(server, "crowd");
  EXPECT_EQ(live["hash"], protocol::hex(map.hash()));
  EXPECT_EQ(live["filled_voxels"], map.filled_voxels());
  EXPECT_EQ(live["mesh_hash"], protocol::hex(onlooker.scene().mesh_hash()));
  EXPECT_EQ(onlooker.scene().seq(), 8000u);
}

}  // namespace
}  // namespace earthwork::e2e
