// What is asked over HTTP of maps that lie on a shelf: they are opened for it, and nothing is told
// that is not stored.
#include "server/net/map_question.hpp"

#include <gtest/gtest.h>

#include <future>
#include <nlohmann/json.hpp>

#include "server/net/api.hpp"
#include "server/room/manual_context.hpp"
#include "tests/room/atlas_calls.hpp"
#include "tests/room/kept_shelf.hpp"
#include "tests/room/onlooker.hpp"

namespace earthwork::net {
namespace {

using nlohmann::json;
using protocol::Code;

struct MapQuestionTest : testing::Test {
  MapQuestionTest() {
    shelf->put("a", {.settings = {}, .epoch = 0xA, .created_ms = 1});
    EXPECT_TRUE(atlas.take_stock());
  }

  /// The answer, once there is one. Nothing else of `ask` waits.
  std::future<HttpResponse> begin(const char* method, const std::string& target,
                                  std::string body = {}) {
    HttpRequest request{.method = method,
                        .target = target,
                        .host = "localhost:8080",
                        .origin = {},
                        .content_type = "application/json",
                        .accept_encoding = {},
                        .if_none_match = {},
                        .body = std::move(body)};
    auto promise = std::make_shared<std::promise<HttpResponse>>();
    api.handle(std::move(request), [promise](HttpResponse r) { promise->set_value(std::move(r)); });
    context.run();
    return promise->get_future();
  }
  HttpResponse ask(const char* method, const std::string& target, std::string body = {}) {
    auto answer = begin(method, target, std::move(body));
    if (answer.wait_for(std::chrono::seconds(20)) != std::future_status::ready)
      throw std::runtime_error("no answer");
    return answer.get();
  }
  static bool answered(const std::future<HttpResponse>& answer) {
    return answer.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  }
  static std::uint64_t seq_in(const HttpResponse& answer) {
    return json::parse(answer.body).at("seq").get<std::uint64_t>();
  }
  void is_problem(const HttpResponse& answer, int status, Code code) {
    EXPECT_EQ(answer.status, status) << answer.body;
    EXPECT_EQ(json::parse(answer.body).at("type"), "urn:earthwork:" + std::string(name(code)));
    const bool told_when = std::any_of(answer.headers.begin(), answer.headers.end(),
                                       [](const auto& h) { return h.first == "Retry-After"; });
    EXPECT_EQ(told_when, status == 503);
  }
  void enter() {
    room = room::find_map(atlas, "a");
    viewer = room->join(std::make_shared<room::Onlooker>(), {}).value().viewer;
  }
  void paint() {
    EXPECT_TRUE(room->submit(
        viewer, {.id = ++id,
                 .author = 7,
                 .action = protocol::Edit{.radius = 3, .path = {{5, 5}}, .stroke = {}}}));
    context.run();
  }

  room::ManualContext context;
  std::shared_ptr<room::KeptShelf> shelf = std::make_shared<room::KeptShelf>();
  room::Atlas atlas{{.make_strand = [this] { return context.make_strand(); }, .shelf = shelf}};
  Workers workers{1};
  Api api{atlas, workers, Access({"127.0.0.1", 8080}, {})};
  std::shared_ptr<room::Room> room;
  room::ViewerId viewer = 0;
  protocol::MessageId id = 0;
};

TEST_F(MapQuestionTest, OpensTheMapForIt) {
  EXPECT_EQ(ask("GET", "/api/maps").body, "{\"maps\":[{\"name\":\"a\"}]}\n");
  EXPECT_EQ(shelf->maps.at("a").opened, 0);
  const auto described = json::parse(ask("GET", "/api/maps/a").body);
  EXPECT_EQ(described.at("epoch"), "000000000000000a");
  EXPECT_EQ(shelf->maps.at("a").opened, 1);
  EXPECT_EQ(json::parse(ask("GET", "/api/maps").body).at("maps").at(0).at("epoch"),
            "000000000000000a");
  is_problem(ask("GET", "/api/maps/b"), 404, Code::unknown_map);
}

TEST_F(MapQuestionTest, AnswersWaitUntilWhatTheyShowIsStored) {
  enter();
  paint();
  for (const char* part :
       {"figures", "states.png", "states.png?layer=9", "export.glb", "export.glb?seq=1"}) {
    shelf->hold();
    paint();
    auto answer = begin("GET", "/api/maps/a/" + std::string(part));
    EXPECT_FALSE(answered(answer)) << part;
    shelf->go_on();
    context.run();
    ASSERT_EQ(answer.wait_for(std::chrono::seconds(20)), std::future_status::ready) << part;
    EXPECT_LT(answer.get().status, 502) << part;
  }
}

TEST_F(MapQuestionTest, ADescriptionShowsWhatIsStoredAndDoesNotWait) {
  enter();
  paint();
  shelf->hold();
  paint();
  EXPECT_EQ(seq_in(ask("GET", "/api/maps/a")), 1u);
  shelf->go_on();
  context.run();
  EXPECT_EQ(seq_in(ask("GET", "/api/maps/a")), 2u);
}

TEST_F(MapQuestionTest, AsksAgainWhenItWasTakenBack) {
  enter();
  paint();
  shelf->hold();
  paint();
  auto answer = begin("GET", "/api/maps/a/figures");
  EXPECT_FALSE(answered(answer));
  shelf->maps.at("a").unwritable = {Code::disk_full, "no room", {}};
  shelf->go_on();
  context.run();
  ASSERT_TRUE(answered(answer));
  EXPECT_EQ(seq_in(answer.get()), 1u);
}

TEST_F(MapQuestionTest, AsksTheNextRoomWhenOneHasClosed) {
  enter();
  paint();
  shelf->hold();
  paint();
  auto answer = begin("GET", "/api/maps/a/figures");
  shelf->maps.at("a").unwritable = {Code::bad_state, "somebody else has written", {}};
  room.reset();
  shelf->go_on();
  context.run();
  ASSERT_TRUE(answered(answer));
  EXPECT_EQ(seq_in(answer.get()), 1u);
  EXPECT_EQ(shelf->maps.at("a").opened, 2);
}

TEST_F(MapQuestionTest, ARoomThatHasClosedAnswersForItsMapNoMore) {
  enter();
  paint();
  shelf->maps.at("a").unwritable = {Code::damaged, "a sum is wrong", {}};
  paint();  // its map has an event that its journal has not
  ASSERT_TRUE(room->closed());
  shelf->maps.at("a").unwritable.reset();
  room.reset();
  for (const char* part : {"figures", "states.png", "export.glb"}) {
    EXPECT_EQ(ask("GET", "/api/maps/a/" + std::string(part)).status, 200) << part;
    EXPECT_EQ(shelf->maps.at("a").opened, 2) << part;
  }
}

TEST_F(MapQuestionTest, EndsWhenNothingIsEverKept) {
  int asked = 0;
  std::optional<HttpResponse> answer;
  ask_map(
      atlas, "a",
      [&](const RoomPointer&, const Given& give) {
        ++asked;
        give(std::nullopt);
      },
      [&](HttpResponse response) { answer = std::move(response); });
  context.run();
  EXPECT_EQ(asked, kMaxTries);
  ASSERT_TRUE(answer);
  is_problem(*answer, 503, Code::unavailable);
}

TEST_F(MapQuestionTest, SaysWhyAMapIsNotServed) {
  const std::pair<Code, int> refusals[] = {{Code::damaged, 500},
                                           {Code::storage_failed, 503},
                                           {Code::read_only, 503},
                                           {Code::unavailable, 503},
                                           {Code::disk_full, 507}};
  for (const auto& [code, status] : refusals) {
    shelf->maps.at("a").broken = {code, "a.earthwork: not now", {}};
    is_problem(ask("GET", "/api/maps/a"), status, code);
    is_problem(ask("GET", "/api/maps/a/figures"), status, code);
    context.advance(room::kTroublePause);
  }
  shelf->maps.at("a").broken = {Code::bad_version, "of a later version", {}};
  is_problem(ask("GET", "/api/maps/a"), 501, Code::not_supported);
}

TEST_F(MapQuestionTest, ANewMapIsStoredWhenItIsAnswered) {
  const auto made = ask("POST", "/api/maps", R"({"name":"b"})");
  EXPECT_EQ(made.status, 201);
  EXPECT_TRUE(shelf->maps.contains("b"));
  shelf->full = {Code::disk_full, "no room", {}};
  is_problem(ask("POST", "/api/maps", R"({"name":"c"})"), 507, Code::disk_full);
  is_problem(ask("GET", "/api/maps/c"), 404, Code::unknown_map);
}

TEST_F(MapQuestionTest, ADeletedMapIsGoneWhenItIsAnswered) {
  EXPECT_EQ(ask("DELETE", "/api/maps/a").status, 204);
  EXPECT_TRUE(shelf->maps.empty());
  shelf->put("d", {});
  is_problem(ask("DELETE", "/api/maps/d"), 404, Code::unknown_map);  // nobody was told of it
  is_problem(ask("POST", "/api/maps", R"({"name":"d"})"), 409, Code::map_exists);
  shelf->maps.at("d").broken = {Code::read_only, "it may not", {}};
  is_problem(ask("DELETE", "/api/maps/d"), 503, Code::read_only);
  EXPECT_TRUE(shelf->maps.contains("d"));
}

}  // namespace
}  // namespace earthwork::net
