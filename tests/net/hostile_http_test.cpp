// Requests that no client of ours would send: each has its answer, and a painter notices nothing.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/net/hostile_server.hpp"
#include "tests/room/atlas_calls.hpp"

namespace earthwork::net {
namespace {

using nlohmann::json;

struct HostileHttpTest : HostileTest {
  std::string own_name() const { return server->address().text(); }
  std::string host() const { return "Host: " + own_name() + "\r\n"; }
  HttpAnswer get(const std::string& target, const std::string& headers) const {
    return http(port, "GET " + target + " HTTP/1.1\r\n" + headers + "Connection: close\r\n\r\n");
  }
  HttpAnswer get(const std::string& target) const { return get(target, host()); }
  HttpAnswer post(const std::string& headers, const std::string& body) const {
    return http(port, "POST /api/maps HTTP/1.1\r\n" + host() +
                          "Content-Type: application/json\r\n" + headers + "\r\n" + body);
  }
  /// The answer to a WebSocket's opening in which `from` stands as `to`.
  HttpAnswer open(const std::string& from, const std::string& to) const {
    std::string request = handshake_text(own_name());
    request.replace(request.find(from), from.size(), to);
    return http(port, request);
  }
  static void is_problem(const HttpAnswer& answer, int status, const std::string& field = {}) {
    EXPECT_EQ(answer.status, status) << answer.body;
    ASSERT_TRUE(answer.headers.contains("content-type"));
    ASSERT_EQ(answer.headers.at("content-type"), "application/problem+json");
    const json problem = json::parse(answer.body);
    EXPECT_EQ(problem.at("status"), status);
    EXPECT_FALSE(problem.at("detail").get<std::string>().empty());
    EXPECT_EQ(problem.value("field", ""), field) << answer.body;
    EXPECT_LT(answer.body.size(), 1000u);
  }
};

TEST_F(HostileHttpTest, PathsThatLeadOut) {
  for (const char* target : {"/../etc/passwd",
                             "/../../../../etc/passwd",
                             "/./",
                             "/..",
                             "//etc/passwd",
                             "//",
                             "/api/../",
                             "/%2e%2e/etc/passwd",
                             "/%2E%2E%2Fetc%2Fpasswd",
                             "/..%2fetc%2fpasswd",
                             "/..%c0%af..",
                             "/%00",
                             "/..\\..\\etc\\passwd",
                             "/..;/etc/passwd",
                             "/etc/passwd",
                             "/.git/config",
                             "/api/maps/../../etc/passwd",
                             "/api/maps/..",
                             "/api/maps/m/../../../etc/passwd",
                             "/api/maps/%2e%2e/figures",
                             "/api/maps/m\\..",
                             "file:///etc/passwd",
                             "*",
                             "etc/passwd"})
    is_problem(get(target), 404);
}

TEST_F(HostileHttpTest, TargetsThatAreVeryLong) {
  is_problem(get("/" + std::string(15'000, 'a')), 404);
  is_problem(get("/api/maps/" + std::string(15'000, 'a')), 404);
  is_problem(get("/" + std::string(20'000, 'a')), 431);
  std::string many = "/?";
  for (int i = 0; i < 2'500; ++i) many += "a" + std::to_string(i) + "&";
  EXPECT_EQ(get(many).status, 200);
}

TEST_F(HostileHttpTest, TargetsOfStrangeBytes) {
  is_problem(get("/\xFF\xFE"), 404);
  is_problem(get("/a\x01z"), 400);
  is_problem(get("/a b"), 400);
}

TEST_F(HostileHttpTest, StrangeHosts) {
  for (const std::string& name :
       {std::string("evil.example"), std::string("localhost"),
        "evil.example:" + std::to_string(port), own_name() + ".evil.example",
        own_name() + "@evil.example", "user@" + own_name(), own_name() + "/", own_name() + " x",
        std::string("127.1"), std::string("[::1"), std::string(8'000, 'a')})
    is_problem(get("/healthz", "Host: " + name + "\r\n"), 403, "Host");
  is_problem(get("/healthz", "Host:\r\n"), 403, "Host");
}

TEST_F(HostileHttpTest, NoHostOrTwo) {
  is_problem(get("/healthz", ""), 400, "Host");
  is_problem(get("/healthz", host() + host()), 400, "Host");
  is_problem(get("/healthz", host() + "Host: evil.example\r\n"), 400, "Host");
  is_problem(http(port, "GET /healthz HTTP/1.0\r\n\r\n"), 400, "Host");
}

TEST_F(HostileHttpTest, ForeignOrigins) {
  for (const std::string& origin :
       {std::string("http://evil.example"), std::string("null"), std::string("file://"),
        "https://" + own_name(), "http://" + own_name() + ".evil.example",
        "http://" + own_name() + "/", std::string("http://"), std::string("*"),
        "http://" + own_name() + ", http://evil.example"}) {
    is_problem(get("/healthz", host() + "Origin: " + origin + "\r\n"), 403, "Origin");
    EXPECT_EQ(SocketClient(port, {.origin = origin}).status(), 403) << origin;
  }
  is_problem(get("/healthz", host() + "Origin: http://" + own_name() + "\r\nOrigin: null\r\n"), 403,
             "Origin");
}

TEST_F(HostileHttpTest, TargetsThatAreUrls) {
  EXPECT_EQ(get("http://" + own_name() + "/healthz").body, "ok\n");
  is_problem(get("http://evil.example/healthz"), 403, "Host");
  is_problem(get("http://user@" + own_name() + "/healthz"), 403, "Host");
  is_problem(get("http://" + own_name() + "/../etc/passwd"), 404);
  is_problem(get("https://" + own_name() + "/healthz"), 404);
  EXPECT_EQ(open("/ws", "http://" + own_name() + "/ws").status, 101);
  is_problem(open("/ws", "http://evil.example/ws"), 403, "Host");
}

TEST_F(HostileHttpTest, LengthsThatDisagree) {
  const std::string body = R"({"name":"a"})";
  is_problem(post("Content-Length: 12\r\nContent-Length: 2\r\n", body), 400);
  is_problem(post("Content-Length: 2\r\nContent-Length: 12\r\n", body), 400);
  is_problem(post("Content-Length: 12, 2\r\n", body), 400);
  is_problem(post("Content-Length: -1\r\n", body), 400);
  is_problem(post("Content-Length: 0x0c\r\n", body), 400);
  is_problem(post("Content-Length: 99999999999999999999\r\n", body), 400);
  is_problem(post("Content-Length: 12\r\nTransfer-Encoding: chunked\r\n", body), 400);
  is_problem(post("Content-Length: 65537\r\n", ""), 413);
  EXPECT_EQ(room::find_map(server->atlas(), "a"), nullptr);
  // Said twice and the same, it is one (RFC 9112, 6.3).
  EXPECT_EQ(post("Content-Length: 12\r\nContent-Length: 12\r\n", body).status, 201);
}

TEST_F(HostileHttpTest, BodiesInEndlessPieces) {
  std::string pieces;
  for (int i = 0; i < 20; ++i) pieces += "2000\r\n" + std::string(0x2000, ' ') + "\r\n";
  is_problem(post("Transfer-Encoding: chunked\r\n", pieces), 413);
  is_problem(post("Transfer-Encoding: chunked\r\n", "FFFFFFFFFFFFFFFF\r\n"), 413);
  is_problem(post("Transfer-Encoding: chunked\r\n", "xyz\r\n"), 400);
}

TEST_F(HostileHttpTest, OpeningsThatLackSomething) {
  const std::string key = "AAAAAAAAAAAAAAAAAAAAAA==";
  is_problem(open("Sec-WebSocket-Key: " + key + "\r\n", ""), 400, "Sec-WebSocket-Key");
  is_problem(open(key, "AAAA=="), 400, "Sec-WebSocket-Key");
  is_problem(open(key, ""), 400, "Sec-WebSocket-Key");
  is_problem(open(key, std::string(500, 'A')), 400, "Sec-WebSocket-Key");
  is_problem(open(key, key + "\r\nSec-WebSocket-Key: " + key), 400, "Sec-WebSocket-Key");
  is_problem(open("earthwork.v1", "chat"), 400, "Sec-WebSocket-Protocol");
  is_problem(open("Sec-WebSocket-Protocol: earthwork.v1\r\n", ""), 400, "Sec-WebSocket-Protocol");
  is_problem(open("GET /ws", "POST /ws"), 405);
  is_problem(open("HTTP/1.1", "HTTP/1.0"), 426);
  is_problem(open("Connection: Upgrade\r\n", ""), 426);
  is_problem(open("/ws", "/wx"), 404);

  const HttpAnswer other = open("Version: 13", "Version: 8");
  is_problem(other, 426, "Sec-WebSocket-Version");
  EXPECT_EQ(other.headers.at("sec-websocket-version"), "13");
}

TEST_F(HostileHttpTest, MapsThatAreNotThere) {
  is_problem(get("/api/maps/nope"), 404);
  is_problem(get("/api/maps/nope/figures"), 404);
  is_problem(get("/api/maps/nope/export.glb"), 404);
  is_problem(get("/api/maps/M"), 404);
  is_problem(get("/api/maps/m/export.obj"), 404);
}

TEST_F(HostileHttpTest, BodiesThatAreNoJson) {
  const auto body = [&](const std::string& text) {
    return post("Content-Length: " + std::to_string(text.size()) + "\r\n", text);
  };
  is_problem(body(std::string(3000, '[')), 400);
  is_problem(body("{\"name\":\"\xFF\"}"), 400);
  is_problem(body(R"({"name":"a","settings":{"voxel_size":1e400}})"), 400, "voxel_size");
  is_problem(body(R"({"name":"a","settings":{"voxel_size":NaN}})"), 400);
  is_problem(body(R"({"name":"../a"})"), 400, "name");
  EXPECT_EQ(room::find_map(server->atlas(), "a"), nullptr);
}

}  // namespace
}  // namespace earthwork::net
