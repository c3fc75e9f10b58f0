// Every limit of protocol/README.md on what comes over the wire: what is at it passes, what is one
// past it is refused, and told which field and which bound.
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "protocol/limits.hpp"
#include "server/net/server.hpp"
#include "tests/net/painter.hpp"
#include "tests/net/raw_client.hpp"

namespace earthwork::net {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

/// How far a session is when the message comes.
enum class Stage { opened, greeted, joined };

/// A message's text without its type and id; `map` is where it is sent once joined.
struct Limit {
  const char* name;
  const char* type;
  std::string at, past;
  const char* code;
  const char* field;
  const char* bound;  ///< Part of what is said of the second.
  const char* map = "m8";
  Stage stage = Stage::joined;
  const char* passes = "";  ///< The code that the first is refused with for another reason.
};

std::string repeated(const std::string& text, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

/// An edit at (1, 1) with a radius of 1, but for `field`.
std::string edit(const std::string& field) {
  json edit{{"stencil", "circle"}, {"fill", true}, {"x", 1}, {"y", 1}, {"radius", 1}};
  edit.update(json::parse("{" + field + "}"));
  const std::string text = edit.dump();
  return text.substr(1, text.size() - 2);
}

std::string path_edit(const std::vector<std::pair<double, double>>& points, double radius) {
  return R"("stencil":"circle","fill":true,"radius":)" + std::to_string(radius) + R"(,"path":)" +
         json(points).dump();
}

std::string same_point(std::size_t count, double radius) {
  return path_edit({count, {0.0, 0.0}}, radius);
}

/// Stamps far from each other on chunks of 8 voxels: each reaches from its corner into the 4 chunks
/// around it, the last one from the middle of a chunk into 9 when `nine`.
std::string scattered(int count, bool nine) {
  std::vector<std::pair<double, double>> points;
  for (int i = 1; i <= count; ++i) points.emplace_back(32.0 * i, 32.0 * (i % 40));
  if (nine) points.back().first += 4, points.back().second += 4;
  return path_edit(points, 4.9);
}

std::vector<Limit> edit_limits() {
  return {
      {"radius", "edit", edit(R"("radius":512)"), edit(R"("radius":512.000001)"), "out_of_range",
       "radius", "512", "m64"},
      {"radius_below", "edit", edit(R"("radius":0)"), edit(R"("radius":-1e-300)"), "out_of_range",
       "radius", "below 0"},
      {"radius_in_voxels", "edit", edit(R"("radius":256)"), edit(R"("radius":256.000001)"),
       "out_of_range", "radius", "512", "half"},
      {"x", "edit", edit(R"("x":1000000)"), edit(R"("x":1000000.0001)"), "out_of_range", "x",
       "1000000"},
      {"x_below", "edit", edit(R"("x":-1000000)"), edit(R"("x":-1000000.0001)"), "out_of_range",
       "x", "1000000"},
      {"y", "edit", edit(R"("y":1000000)"), edit(R"("y":1000000.0001)"), "out_of_range", "y",
       "1000000"},
      {"y_in_voxels", "edit", edit(R"("y":500000)"), edit(R"("y":500000.0001)"), "out_of_range",
       "y", "1000000", "half"},
      {"path_place", "edit", path_edit({{1, 1}, {1, -1e6}}, 1),
       path_edit({{1, 1}, {1, -1000000.5}}, 1), "out_of_range", "path", "1000000"},
      {"path_points", "edit", same_point(1024, 0), same_point(1025, 0), "out_of_range", "path",
       "1024"},
      {"path_points_below", "edit", same_point(1, 0), same_point(0, 0), "out_of_range", "path",
       "1 .. 1024"},
      // (floor(2 * 511.5) + 1)^2 = 2^20 visits a stamp.
      {"visits", "edit", same_point(16, 511.5), same_point(17, 511.5), "too_large", "path",
       "16777216", "m64"},
      {"chunks", "edit", scattered(1024, false), scattered(1023, true), "too_large", "path",
       "4097 chunks are beyond the limit of 4096"},
      // 64 x 64 chunks, and 66 x 66.
      {"chunks_of_one_stamp", "edit", edit(R"("x":256,"y":256,"radius":254.9)"),
       edit(R"("x":256,"y":256,"radius":255.1)"), "too_large", "radius", "4096"},
      {"layer_of_one", "edit", edit(R"("layer":0)"), edit(R"("layer":1)"), "out_of_range", "layer",
       "0 .. 0"},
      {"layer", "edit", edit(R"("layer":15)"), edit(R"("layer":16)"), "out_of_range", "layer",
       "0 .. 15", "layers"},
      {"stroke", "edit", edit(R"("stroke":9007199254740991)"), edit(R"("stroke":9007199254740992)"),
       "out_of_range", "stroke", "9007199254740991"},
      {"stroke_below", "edit", edit(R"("stroke":-9007199254740991)"),
       edit(R"("stroke":-9007199254740992)"), "out_of_range", "stroke", "-9007199254740991"},
  };
}

std::vector<Limit> view_limits() {
  // The cells of chunk x of 8 voxels begin at 8 x + 0.5.
  return {
      {"view_n", "view", R"("n":4294967295,"rect":[0,0,8,8])", R"("n":4294967296,"rect":[0,0,8,8])",
       "out_of_range", "n", "4294967295"},
      {"view_n_below", "view", R"("n":0,"rect":[0,0,8,8])", R"("n":-1,"rect":[0,0,8,8])",
       "out_of_range", "n", "0 .. "},
      {"view_chunks", "view", R"("n":1,"rect":[1,1,131071,7])", R"("n":1,"rect":[1,1,131079,7])",
       "too_large", "rect", "16385 chunks are beyond the limit of 16384"},
      {"view_square", "view", R"("n":1,"rect":[1,1,1023,1023])", R"("n":1,"rect":[1,1,1023,1031])",
       "too_large", "rect", "16384"},
      {"view_epoch", "view",
       R"("n":1,"all":true,"have":{"epoch":"0123456789abcdef","seq":0,"rect":[0,0,1,1]})",
       R"("n":1,"all":true,"have":{"epoch":"0123456789abcdef0","seq":0,"rect":[0,0,1,1]})",
       "bad_field", "have.epoch", "16"},
      {"view_seq", "view",
       R"("n":1,"all":true,"have":{"epoch":"0123456789abcdef","seq":9007199254740991,"rect":[0,0,1,1]})",
       R"("n":1,"all":true,"have":{"epoch":"0123456789abcdef","seq":9007199254740992,"rect":[0,0,1,1]})",
       "out_of_range", "have.seq", "9007199254740991"},
  };
}

std::vector<Limit> other_limits() {
  const std::string smile = "\xF0\x9F\x98\x80";  // one character in four bytes
  const auto named = [](const std::string& name) {
    return R"("protocol":[1,1],"name":")" + name + "\"";
  };
  const auto mapped = [](const std::string& name) { return R"("map":")" + name + "\""; };
  const auto keyed = [&](int digits) {
    return named("x") + R"(,"key":")" + std::string(static_cast<std::size_t>(digits), '0') + "\"";
  };
  const auto nested = [](int levels) {
    return R"("note":)" + repeated("[", levels) + repeated("]", levels);
  };
  return {
      {"json_depth", "ping", nested(15), nested(16), "bad_json", "", "16"},
      {"name", "hello", named(std::string(64, 'x')), named(std::string(65, 'x')), "out_of_range",
       "name", "1 .. 64", "m8", Stage::opened},
      {"name_of_wide_characters", "hello", named(repeated(smile, 64)), named(repeated(smile, 65)),
       "out_of_range", "name", "1 .. 64", "m8", Stage::opened},
      {"name_below", "hello", named("x"), named(""), "out_of_range", "name", "1 .. 64", "m8",
       Stage::opened},
      {"protocol", "hello", R"("protocol":[1,65535],"name":"x")",
       R"("protocol":[1,65536],"name":"x")", "out_of_range", "protocol", "65535", "m8",
       Stage::opened},
      {"key", "hello", keyed(32), keyed(33), "bad_field", "key", "32", "m8", Stage::opened},
      {"key_below", "hello", keyed(32), keyed(31), "bad_field", "key", "32", "m8", Stage::opened},
      {"map_name", "join", mapped(std::string(64, 'a')), mapped(std::string(65, 'a')), "bad_name",
       "map", "1-64", "m8", Stage::greeted},
      {"events_from", "events", R"("from_seq":1)", R"("from_seq":0)", "out_of_range", "from_seq",
       "1 .. "},
      {"events_integer", "events", R"("from_seq":9007199254740991)",
       R"("from_seq":9007199254740992)", "out_of_range", "from_seq", "9007199254740991", "m8",
       Stage::joined, "out_of_range"},
      {"cursor_x", "cursor", R"("x":1000000,"y":0)", R"("x":1000000.0001,"y":0)", "out_of_range",
       "x", "1000000"},
      {"cursor_y", "cursor", R"("x":0,"y":-1000000)", R"("x":0,"y":-1000000.0001)", "out_of_range",
       "y", "1000000"},
      {"brush_radius", "cursor",
       R"("x":0,"y":0,"brush":{"stencil":"circle","radius":512,"fill":true})",
       R"("x":0,"y":0,"brush":{"stencil":"circle","radius":512.0001,"fill":true})", "out_of_range",
       "radius", "512", "m64"},
      {"brush_layer", "cursor",
       R"("x":0,"y":0,"brush":{"stencil":"circle","radius":1,"fill":true,"layer":0})",
       R"("x":0,"y":0,"brush":{"stencil":"circle","radius":1,"fill":true,"layer":1})",
       "out_of_range", "layer", "1"},
  };
}

struct LimitServer : testing::Test {
  explicit LimitServer(const SessionLimits& limits = {}) {
    server =
        Server::start({.listen = {"127.0.0.1", 0}, .allowed_hosts = {}, .limits = limits}).value();
    port = server->address().port;
    make(R"({"name":"m8","settings":{"chunk_resolution":8}})");
    make(R"({"name":"m64","settings":{"chunk_resolution":64}})");
    make(R"({"name":"half","settings":{"chunk_resolution":64,"voxel_size":0.5}})");
    make(R"({"name":"layers","settings":{"layers":[)" + repeated("{},", 15) + "{}]}}");
    make(R"({"name":")" + std::string(64, 'a') + "\"}");
  }

  HttpAnswer post(const std::string& body) const {
    return http(port, "POST /api/maps HTTP/1.1\r\nHost: " + server->address().text() +
                          "\r\nContent-Type: application/json\r\nConnection: close\r\n"
                          "Content-Length: " +
                          std::to_string(body.size()) + "\r\n\r\n" + body);
  }
  void make(const std::string& map) const { ASSERT_EQ(post(map).status, 201) << map; }

  std::unique_ptr<SocketClient> guest(Stage stage, const std::string& map) const {
    auto client = std::make_unique<SocketClient>(port);
    if (stage == Stage::joined) enter(*client, map);
    if (stage == Stage::greeted) {
      client->text(R"({"type":"hello","protocol":[1,1],"name":"ann","id":1})");
      EXPECT_EQ(reply(*client).at("type"), "welcome");
    }
    return client;
  }
  static json ask(SocketClient& client, const std::string& type, const std::string& id,
                  const std::string& rest) {
    client.text(R"({"type":")" + type + R"(","id":)" + id + (rest.empty() ? "" : ",") + rest + "}");
    return reply(client);
  }

  std::unique_ptr<Server> server;
  std::uint16_t port = 0;
};

struct LimitsTest : LimitServer, testing::WithParamInterface<Limit> {};

TEST_P(LimitsTest, HoldsAtItAndNotOnePast) {
  const Limit& limit = GetParam();
  const auto refused_of = [&](SocketClient& client, const char* id) {
    const json answer = ask(client, limit.type, id, limit.past);
    EXPECT_EQ(answer.value("type", ""), "rejected") << answer;
    EXPECT_EQ(answer.value("code", ""), limit.code) << answer;
    EXPECT_EQ(answer.value("field", ""), limit.field) << answer;
    EXPECT_NE(answer.value("message", "").find(limit.bound), std::string::npos) << answer;
    EXPECT_EQ(answer.value("id", 0), std::stoi(id)) << answer;
  };
  const auto client = guest(limit.stage, limit.map);
  refused_of(*client, "10");
  const json answer = ask(*client, limit.type, "11", limit.at);
  EXPECT_EQ(answer.value("code", ""), limit.passes) << answer;
  EXPECT_EQ(answer.value("id", 0), 11) << answer;
}

std::string name_of(const testing::TestParamInfo<Limit>& info) { return info.param.name; }
INSTANTIATE_TEST_SUITE_P(Edits, LimitsTest, testing::ValuesIn(edit_limits()), name_of);
INSTANTIATE_TEST_SUITE_P(Views, LimitsTest, testing::ValuesIn(view_limits()), name_of);
INSTANTIATE_TEST_SUITE_P(Others, LimitsTest, testing::ValuesIn(other_limits()), name_of);

TEST_F(LimitServer, IdsGoFromOneToTheLargestInteger) {
  const auto client = guest(Stage::joined, "m8");
  for (const char* type : {"ping", "edit"}) {
    const std::string rest = type == std::string("edit") ? edit("") : "";
    for (const char* past : {"0", "-1", "9007199254740992", "18446744073709551616"}) {
      const json answer = ask(*client, type, past, rest);
      EXPECT_EQ(answer.value("field", ""), "id") << type << past << answer;
      EXPECT_FALSE(answer.contains("id")) << answer;
    }
    EXPECT_EQ(ask(*client, type, "0", rest).at("code"), "out_of_range");
    const json past = ask(*client, type, "9007199254740992", rest);
    EXPECT_NE(past.at("message").get<std::string>().find("9007199254740991"), std::string::npos);
    EXPECT_EQ(ask(*client, type, "3", rest).value("id", 0), 3);
    EXPECT_FALSE(ask(*client, type, "9007199254740991", rest).contains("code"));
  }
}

TEST_F(LimitServer, AMessageMayHaveSoManyBytesAndNotOneMore) {
  const auto padded = [](std::size_t bytes) {
    std::string message = R"({"type":"ping","id":9,"note":")";
    message.append(bytes - message.size() - 2, 'x');
    return message + "\"}";
  };
  const auto client = guest(Stage::joined, "m8");
  client->text(padded(protocol::kMaxControlBytes));
  EXPECT_EQ(reply(*client).at("id"), 9);
  client->text(padded(protocol::kMaxControlBytes + 1));
  const json bye = reply(*client);
  EXPECT_EQ(bye.at("type"), "bye");
  EXPECT_EQ(bye.at("code"), "too_large");
  EXPECT_NE(bye.at("message").get<std::string>().find("65536"), std::string::npos);
  EXPECT_EQ(client->receive().kind, SocketClient::Kind::closed);
}

TEST_F(LimitServer, AllOfAMapMayHaveSoManyChunksAndNotOneMore) {
  const auto client = guest(Stage::joined, "m8");
  int id = 10;
  const auto paint = [&](const std::string& field) {
    const json answer = ask(*client, "edit", std::to_string(++id), edit(field));
    ASSERT_EQ(answer.at("type"), "applied") << answer;
  };
  const std::string all = R"("n":1,"all":true)";
  for (const char* place :
       {R"("x":256,"y":256)", R"("x":768,"y":256)", R"("x":256,"y":768)", R"("x":768,"y":768)"})
    paint(R"("stencil":"square","radius":254.9,)" + std::string(place));
  const json at = ask(*client, "view", "20", all);
  EXPECT_EQ(at.at("type"), "done") << at;

  const auto other = guest(Stage::joined, "m8");
  paint(R"("x":-20,"y":-20)");
  const json past = ask(*other, "view", "20", all);
  EXPECT_EQ(past.value("code", ""), "too_large") << past;
  EXPECT_EQ(past.value("field", ""), "all") << past;
  EXPECT_NE(past.value("message", "").find("16384"), std::string::npos) << past;
}

/// A map's settings, or its name, at a limit and past it.
struct MapLimit {
  const char* at;
  const char* past;
  const char* field;
  const char* bound;
};

TEST_F(LimitServer, SettingsHoldTheirLimits) {
  const std::string wide = std::string(64, 'x');
  const std::string named = R"("layers":[{"name":")" + wide + "\"}]";
  const std::string too_named = R"("layers":[{"name":"x)" + wide + "\"}]";
  const std::string layers = R"("layers":[)" + repeated("{},", 15) + "{}]";
  const std::string too_many = R"("layers":[)" + repeated("{},", 16) + "{}]";
  const MapLimit limits[] = {
      {layers.c_str(), too_many.c_str(), "layers", "1 .. 16"},
      {R"("layers":[{}])", R"("layers":[])", "layers", "1 .. 16"},
      {named.c_str(), too_named.c_str(), "layers[0].name", "64"},
      {R"("wall":[-1000000,1000000])", R"("wall":[-1000000,1000000.5])", "wall", "1000000"},
      {R"("wall":[-1000000,0])", R"("wall":[-1000000.5,0])", "wall", "1000000"},
      {R"("voxel_size":1000000)", R"("voxel_size":1000000.5)", "voxel_size", "1000000"},
      {R"("voxel_size":0.000001)", R"("voxel_size":0.0000009)", "voxel_size", "1e-06"},
      {R"("max_feature_angle":175)", R"("max_feature_angle":175.001)", "max_feature_angle", "175"},
      {R"("max_feature_angle":0.001)", R"("max_feature_angle":0)", "max_feature_angle", "0"},
      {R"("chunk_resolution":64)", R"("chunk_resolution":128)", "chunk_resolution", "64"},
      {R"("chunk_resolution":8)", R"("chunk_resolution":4)", "chunk_resolution", "8"},
      {R"("chunk_resolution":8,"chunks":[-125072,0,125072,1])",
       R"("chunk_resolution":8,"chunks":[0,0,125073,1])", "chunks", "125072"},
      {R"("chunk_resolution":64,"chunks":[-15634,-15634,15634,15634])",
       R"("chunk_resolution":64,"chunks":[-15635,0,0,1])", "chunks", "15634"},
  };
  int map = 0;
  for (const MapLimit& limit : limits) {
    const std::string name = R"({"name":"s)" + std::to_string(++map) + R"(","settings":{)";
    EXPECT_EQ(post(name + limit.at + "}}").status, 201) << limit.at;
    const HttpAnswer refused = post(name + limit.past + "}}");
    EXPECT_EQ(refused.status, 400) << limit.past;
    const json problem = json::parse(refused.body);
    EXPECT_EQ(problem.value("field", ""), limit.field) << refused.body;
    EXPECT_NE(problem.value("detail", "").find(limit.bound), std::string::npos) << refused.body;
  }
  EXPECT_EQ(post(R"({"name":")" + std::string(65, 'a') + "\"}").status, 400);
}

SessionLimits slow() {
  SessionLimits limits;
  limits.messages_per_second = 20;
  limits.message_burst = 10;
  return limits;
}

struct SlowLimitServer : LimitServer {
  SlowLimitServer() : LimitServer(slow()) {}
};

TEST_F(SlowLimitServer, OverItsRateASessionIsNotReadRatherThanRefused) {
  const auto client = guest(Stage::joined, "m8");  // two messages
  const auto start = std::chrono::steady_clock::now();
  constexpr int kPings = 40;
  for (int id = 3; id < 3 + kPings; ++id)
    client->text(R"({"type":"ping","id":)" + std::to_string(id) + "}");
  for (int id = 3; id < 3 + kPings; ++id) {
    const json answer = reply(*client);
    EXPECT_EQ(answer.at("type"), "done") << answer;
    EXPECT_EQ(answer.at("id"), id);
  }
  // Ten of all 42 came at once, the others at 20 a second; half of that leaves room for the time
  // between the first messages.
  EXPECT_GE(std::chrono::steady_clock::now() - start, 800ms);
}

}  // namespace
}  // namespace earthwork::net
