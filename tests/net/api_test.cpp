// The HTTP interface without sockets: every path, method and refusal.
#include "server/net/api.hpp"

#include <gtest/gtest.h>

#include <future>
#include <nlohmann/json.hpp>
#include <thread>

#include "server/room/manual_context.hpp"
#include "tests/net/figure_names.hpp"
#include "tests/room/atlas_calls.hpp"

namespace earthwork::net {
namespace {

using nlohmann::json;

struct ApiTest : testing::Test {
  HttpRequest request(const char* method, const std::string& target, std::string body = {}) {
    HttpRequest made{.method = method,
                     .target = target,
                     .host = "localhost:8080",
                     .origin = {},
                     .content_type = {},
                     .accept_encoding = {},
                     .if_none_match = {},
                     .body = std::move(body)};
    if (!made.body.empty()) made.content_type = "application/json";
    return made;
  }
  HttpResponse ask(HttpRequest asked) {
    auto promise = std::make_shared<std::promise<HttpResponse>>();
    auto answer = promise->get_future();
    api.handle(std::move(asked), [promise](HttpResponse r) { promise->set_value(std::move(r)); });
    context.run();
    if (answer.wait_for(std::chrono::seconds(20)) != std::future_status::ready)
      throw std::runtime_error("no answer");
    return answer.get();
  }
  HttpResponse get(const std::string& target) { return ask(request("GET", target)); }
  HttpResponse create(const std::string& body) { return ask(request("POST", "/api/maps", body)); }
  void paint(const std::string& map, std::vector<protocol::Action> actions) {
    struct Blind final : room::Viewer {
      void answered(std::vector<room::Reply>) override {}
      void deliver(room::Parcel) override {}
      void tell(room::Talk) override {}
      void settings(room::SharedText) override {}
      void end(protocol::Bye) override {}
    };
    const auto room = room::find_map(atlas, map);
    const auto viewer = room->join(std::make_shared<Blind>(), {}).value().viewer;
    for (auto& action : actions) ASSERT_TRUE(room->submit(viewer, {++id, 0, action}));
    context.run();
    room->leave(viewer);
  }
  static std::string header(const HttpResponse& response, const std::string& name) {
    for (const auto& [key, value] : response.headers)
      if (key == name) return value;
    return {};
  }
  void is_problem(const HttpResponse& response, int status) {
    EXPECT_EQ(response.status, status) << response.body;
    EXPECT_EQ(response.content_type, "application/problem+json");
    const json body = json::parse(response.body);
    EXPECT_TRUE(body.at("type").is_string() && body.at("title").is_string());
    EXPECT_TRUE(body.at("detail").is_string());
  }

  protocol::MessageId id = 0;  // of the last edit
  room::ManualContext context;
  room::Atlas atlas{{.make_strand = [this] { return context.make_strand(); }}};
  Workers workers{1};
  Api api{atlas, workers, Access({"127.0.0.1", 8080}, {})};
};

const protocol::Edit kSquare{
    .stencil = protocol::StencilShape::square, .radius = 5, .path = {{16, 16}}, .stroke = {}};

TEST_F(ApiTest, ShowsAPageAndItsHealth) {
  const auto page = get("/");
  EXPECT_EQ(page.status, 200);
  EXPECT_EQ(page.content_type, "text/html; charset=utf-8");
  EXPECT_NE(page.body.find("server/run"), std::string::npos);  // how to get the viewer
  EXPECT_NE(page.body.find("--page"), std::string::npos);
  for (const char* path : {"/api/maps", "figures", "states.png", "export.glb", "/ws", "/metrics"})
    EXPECT_NE(page.body.find(path), std::string::npos) << path;
  EXPECT_EQ(header(page, "X-Content-Type-Options"), "nosniff");
  EXPECT_NE(header(page, "Content-Security-Policy").find("default-src 'none'"), std::string::npos);
  EXPECT_EQ(get("/?map=demo").body, page.body);
  is_problem(get("/index.html"), 404);
  EXPECT_EQ(get("/healthz").body, "ok\n");
}

TEST_F(ApiTest, MakesListsDescribesAndDeletesMaps) {
  EXPECT_EQ(json::parse(get("/api/maps").body), json({{"maps", json::array()}}));
  const auto made = create(R"({"name":"a","settings":{"chunk_resolution":16}})");
  EXPECT_EQ(made.status, 201);
  EXPECT_EQ(header(made, "Location"), "/api/maps/a");

  const json info = json::parse(get("/api/maps/a").body);
  EXPECT_EQ(info, json::parse(made.body));
  EXPECT_EQ(info.at("name"), "a");
  EXPECT_EQ(info.at("settings").at("chunk_resolution"), 16);
  EXPECT_EQ(info.at("epoch").get<std::string>().size(), 16u);
  EXPECT_EQ(info.at("seq"), 0);
  EXPECT_EQ(info.at("hash"), "0000000000000000");
  EXPECT_EQ(info.at("chunks"), 0);
  EXPECT_EQ(info.at("users"), 0);
  EXPECT_EQ(json::parse(get("/api/maps").body).at("maps").at(0).at("name"), "a");

  EXPECT_EQ(ask(request("DELETE", "/api/maps/a")).status, 204);
  is_problem(get("/api/maps/a"), 404);
  is_problem(ask(request("DELETE", "/api/maps/a")), 404);
}

TEST_F(ApiTest, SettingsAreOptional) {
  EXPECT_EQ(create(R"({"name":"a"})").status, 201);
  EXPECT_EQ(room::find_map(atlas, "a")->settings(), protocol::MapSettings{});
}

TEST_F(ApiTest, RefusesMapsThatCannotBe) {
  ASSERT_EQ(create(R"({"name":"a"})").status, 201);
  is_problem(create(R"({"name":"a"})"), 409);
  is_problem(create(R"({"name":"../a"})"), 400);
  is_problem(create(R"({"name":7})"), 400);
  is_problem(create(R"({})"), 400);
  is_problem(create("[]"), 400);
  is_problem(create("{"), 400);
  const auto refused = create(R"({"name":"b","settings":{"chunk_resolution":7}})");
  is_problem(refused, 400);
  EXPECT_EQ(json::parse(refused.body).at("field"), "chunk_resolution");
  EXPECT_EQ(room::find_map(atlas, "b"), nullptr);
}

TEST_F(ApiTest, WhatWritesHasToBeJson) {
  for (const char* type :
       {"text/plain", "application/x-www-form-urlencoded", "application/jsonx"}) {
    auto post = request("POST", "/api/maps", R"({"name":"a"})");
    post.content_type = type;
    is_problem(ask(post), 415);
  }
  auto post = request("POST", "/api/maps", R"({"name":"a"})");
  post.content_type.reset();
  is_problem(ask(post), 415);
  post.content_type = "Application/JSON; charset=utf-8";
  EXPECT_EQ(ask(post).status, 201);
  auto del = request("DELETE", "/api/maps/a", "x=1");
  del.content_type = "text/plain";
  is_problem(ask(del), 415);
  EXPECT_NE(room::find_map(atlas, "a"), nullptr);
}

TEST_F(ApiTest, AnswersOnlyToItsName) {
  auto asked = request("GET", "/api/maps");
  asked.host = "evil.example";
  is_problem(ask(asked), 403);
  asked.host = "localhost:8080";
  asked.origin = "http://evil.example";
  is_problem(ask(asked), 403);
  asked.origin = "http://localhost:8080";
  EXPECT_EQ(ask(asked).status, 200);
}

TEST_F(ApiTest, WantsExactlyOneHost) {
  auto asked = request("GET", "/healthz");
  for (const auto& host : {std::optional<std::string>(),
                           std::optional<std::string>("localhost:8080, localhost:8080")}) {
    asked.host = host;
    const auto refused = ask(asked);
    is_problem(refused, 400);
    EXPECT_EQ(json::parse(refused.body).at("field"), "Host");
  }
}

TEST_F(ApiTest, ATargetThatIsAUrlIsCheckedInPlaceOfTheHost) {
  EXPECT_EQ(get("http://localhost:8080/healthz").body, "ok\n");
  EXPECT_EQ(get("HTTP://127.0.0.1:8080").status, 200);
  for (const char* target :
       {"http://evil.example/healthz", "http://localhost:8081/", "http:///healthz",
        "http://evil.example@localhost:8080/", "http://localhost:8080@evil.example/"})
    is_problem(get(target), 403);
  is_problem(get("https://localhost:8080/healthz"), 404);

  auto asked = request("GET", "http://localhost:8080/healthz");
  asked.host = "proxy.example";  // RFC 9112, 3.2.2: the target's is the one that counts
  EXPECT_EQ(ask(asked).status, 200);
  asked.origin = "http://evil.example";
  is_problem(ask(asked), 403);
}

TEST_F(ApiTest, GivesMetrics) {
  ASSERT_EQ(create(R"({"name":"a"})").status, 201);
  ASSERT_EQ(create(R"({"name":"b"})").status, 201);
  paint("a", {kSquare, kSquare});
  const auto metrics = get("/metrics");
  EXPECT_EQ(metrics.status, 200);
  EXPECT_EQ(metrics.content_type, "text/plain; version=0.0.4; charset=utf-8");
  EXPECT_NE(metrics.body.find("\nearthwork_maps 2\n"), std::string::npos) << metrics.body;
  EXPECT_NE(metrics.body.find("\nearthwork_edits_total 2\n"), std::string::npos) << metrics.body;

  EXPECT_EQ(ask(request("HEAD", "/metrics")).status, 200);
  is_problem(ask(request("POST", "/metrics")), 405);
  is_problem(get("/metrics/x"), 404);
  auto foreign = request("GET", "/metrics");
  foreign.host = "evil.example";
  is_problem(ask(foreign), 403);
}

TEST_F(ApiTest, SaysWhichMethodsThereAre) {
  ASSERT_EQ(create(R"({"name":"a"})").status, 201);
  const auto allow = [&](const char* method, const char* target) {
    const auto response = ask(request(method, target));
    is_problem(response, 405);
    return header(response, "Allow");
  };
  EXPECT_EQ(allow("POST", "/"), "GET, HEAD");
  EXPECT_EQ(allow("PUT", "/api/maps"), "GET, HEAD, POST");
  EXPECT_EQ(allow("POST", "/api/maps/a"), "GET, HEAD, DELETE");
  EXPECT_EQ(allow("DELETE", "/api/maps/a/figures"), "GET, HEAD");
  EXPECT_EQ(allow("TRACE", "/healthz"), "GET, HEAD");
  EXPECT_EQ(ask(request("HEAD", "/healthz")).status, 200);
}

TEST_F(ApiTest, KnowsNoOtherPath) {
  ASSERT_EQ(create(R"({"name":"a"})").status, 201);
  for (const char* target :
       {"/api", "/api/maps/", "/api/maps/b", "/api/maps/a/", "/api/maps/a/other",
        "/api/maps/a/figures/x", "/../etc/passwd", "/%2e%2e/etc/passwd", "/api/maps/..%2fa",
        "/favicon.ico", "/api/maps/a/export.glb/", "nonsense"})
    is_problem(get(target), 404);
  is_problem(get("/ws"), 426);
}

TEST_F(ApiTest, FiguresHaveEveryNameOfTheConformanceFile) {
  ASSERT_EQ(create(R"({"name":"a"})").status, 201);
  paint("a", {kSquare, kSquare});
  const json figures = json::parse(get("/api/maps/a/figures").body);
  for (const char* name : kFigureNames) EXPECT_TRUE(figures.contains(name)) << name;
  EXPECT_NEAR(figures.at("surface_area").get<double>(), 100, 1e-3);
  EXPECT_NEAR(figures.at("wall_length").get<double>(), 40, 1e-3);
  EXPECT_EQ(figures.at("edits"), 2);
  EXPECT_EQ(figures.at("seq"), 2);
  EXPECT_EQ(figures.at("filled_voxels"), 100);
  EXPECT_EQ(figures.at("cells_by_case").size(), 16u);
  EXPECT_EQ(figures.at("cells_by_case").at("15"), 81);
  EXPECT_EQ(figures.at("hash"), json::parse(get("/api/maps/a").body).at("hash"));
  EXPECT_NE(figures.at("mesh_hash"), "0000000000000000");
  EXPECT_EQ(figures.at("chunks"), 1);
  EXPECT_NEAR(figures.at("bytes_per_voxel").get<double>(),
              figures.at("voxel_bytes").get<double>() / 1024, 1e-9);
}

TEST_F(ApiTest, StatesAreAPicture) {
  ASSERT_EQ(create(R"({"name":"a","settings":{"chunks":[0,0,1,1]}})").status, 201);
  paint("a", {kSquare});
  const auto picture = get("/api/maps/a/states.png?layer=0");
  EXPECT_EQ(picture.status, 200);
  EXPECT_EQ(picture.content_type, "image/png");
  EXPECT_TRUE(picture.body.starts_with("\x89PNG"));
  is_problem(get("/api/maps/a/states.png?layer=1"), 400);
  is_problem(get("/api/maps/a/states.png?layer=-1"), 400);
  is_problem(get("/api/maps/a/states.png?layer="), 400);
  is_problem(get("/api/maps/a/states.png?layer=99999999999999999999"), 400);
}

TEST_F(ApiTest, APictureThatIsTooLargeIsRefused) {
  ASSERT_EQ(
      create(R"({"name":"a","settings":{"chunk_resolution":64,"chunks":[0,0,257,256]}})").status,
      201);
  is_problem(get("/api/maps/a/states.png"), 422);
  ASSERT_EQ(create(R"({"name":"b"})").status, 201);
  is_problem(get("/api/maps/b/states.png"), 409);  // without bounds, nothing to show
}

TEST_F(ApiTest, AnExportHasATag) {
  ASSERT_EQ(create(R"({"name":"a"})").status, 201);
  paint("a", {kSquare});
  const auto file = get("/api/maps/a/export.glb");
  EXPECT_EQ(file.status, 200);
  EXPECT_EQ(file.content_type, "model/gltf-binary");
  EXPECT_TRUE(file.body.starts_with("glTF"));
  const std::string tag = header(file, "ETag");

  auto again = request("GET", "/api/maps/a/export.glb");
  again.if_none_match = tag;
  const auto same = ask(again);
  EXPECT_EQ(same.status, 304);
  EXPECT_EQ(header(same, "ETag"), tag);
  EXPECT_TRUE(same.body.empty());

  paint("a", {protocol::Edit{.radius = 2, .path = {{50, 50}}, .stroke = {}}});
  const auto changed = ask(again);
  EXPECT_EQ(changed.status, 200);
  EXPECT_NE(header(changed, "ETag"), tag);
}

TEST_F(ApiTest, ShowsTheLayersAsTheyHaveBecome) {
  ASSERT_EQ(create(R"({"name":"a"})").status, 201);
  paint("a", {kSquare});
  const auto before = get("/api/maps/a/export.glb");
  is_problem(get("/api/maps/a/states.png?layer=1"), 400);
  const protocol::LayerChange add{.layer = {}, .name = "roof", .color = {}, .wall = {}};
  const protocol::LayerChange paint_it{.layer = 0, .name = {}, .color = "#123456", .wall = {}};
  paint("a", {add, paint_it});
  const json info = json::parse(get("/api/maps/a").body);
  EXPECT_EQ(info.at("seq"), 3);
  EXPECT_EQ(info.at("settings").at("layers").at(0).at("color"), "#123456");
  EXPECT_EQ(info.at("settings").at("layers").at(1).at("name"), "roof");

  // The same meshes in other colours are another file.
  auto again = request("GET", "/api/maps/a/export.glb");
  again.if_none_match = header(before, "ETag");
  const auto after = ask(again);
  EXPECT_EQ(after.status, 200);
  EXPECT_NE(header(after, "ETag"), header(before, "ETag"));
  EXPECT_NE(after.body, before.body);
}

TEST_F(ApiTest, BusyWorkersAreSaidSoBeforeAPictureIsDrawn) {
  ASSERT_EQ(create(R"({"name":"a"})").status, 201);
  std::promise<void> running, go_on;
  ASSERT_TRUE(workers.offer([&] {
    running.set_value();
    go_on.get_future().wait();
  }));
  running.get_future().wait();
  while (!workers.full()) ASSERT_TRUE(workers.offer([] {}));
  // There is nothing to draw, but nobody has looked.
  for (const char* file : {"states.png", "export.glb"}) {
    const auto refused = get(std::string("/api/maps/a/") + file);
    is_problem(refused, 503);
    EXPECT_EQ(header(refused, "Retry-After"), "1");
  }
  EXPECT_EQ(get("/api/maps/a/figures").status, 200);
  go_on.set_value();
  while (workers.full()) std::this_thread::yield();
  is_problem(get("/api/maps/a/states.png"), 409);
}

TEST_F(ApiTest, OnlyTheMapAsItIsCanBeExported) {
  ASSERT_EQ(create(R"({"name":"a"})").status, 201);
  paint("a", {kSquare});
  EXPECT_EQ(get("/api/maps/a/export.glb?seq=1").status, 200);
  const auto refused = get("/api/maps/a/export.glb?seq=0");
  is_problem(refused, 501);
  EXPECT_EQ(json::parse(refused.body).at("type"), "urn:earthwork:not_supported");
  is_problem(get("/api/maps/a/export.glb?seq=x"), 400);
}

}  // namespace
}  // namespace earthwork::net
