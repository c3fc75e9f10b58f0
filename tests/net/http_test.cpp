// HTTP over real sockets: what the API's tests without sockets cannot see.
#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "server/net/api.hpp"
#include "server/net/server.hpp"
#include "tests/net/raw_client.hpp"

namespace earthwork::net {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

struct HttpTest : testing::Test {
  static ServerOptions options(std::chrono::milliseconds request = 60s) {
    ServerOptions options{.listen = {"127.0.0.1", 0}, .allowed_hosts = {}, .limits = {}};
    options.limits.request = request;
    return options;
  }
  explicit HttpTest(const ServerOptions& how = options()) : server(Server::start(how).value()) {}

  std::unique_ptr<Server> server;
  std::uint16_t port = server->address().port;
  std::string host = "Host: " + server->address().text() + "\r\n";

  HttpAnswer post(const std::string& body, const std::string& type = "application/json") {
    return http(port, "POST /api/maps HTTP/1.1\r\n" + host + "Content-Type: " + type +
                          "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
  }
};

TEST_F(HttpTest, PicksAFreePortAndSaysWhich) {
  EXPECT_NE(port, 0);
  EXPECT_EQ(server->url(), "http://127.0.0.1:" + std::to_string(port));
  EXPECT_EQ(http_get(port, "/healthz").body, "ok\n");
}

TEST_F(HttpTest, CannotListenWhereSomebodyDoes) {
  ServerOptions same = options();
  same.listen.port = port;
  const auto second = Server::start(same);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().detail.find(std::to_string(port)), std::string::npos);
}

TEST_F(HttpTest, MakesAMapAndShowsIt) {
  EXPECT_EQ(post(R"({"name":"a"})").status, 201);
  EXPECT_EQ(post(R"({"name":"a"})").status, 409);
  EXPECT_EQ(post(R"({"name":"b"})", "text/plain").status, 415);
  const HttpAnswer answer = http_get(port, "/api/maps/a");
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.headers.at("content-type"), "application/json");
  EXPECT_EQ(json::parse(answer.body).at("name"), "a");
}

TEST_F(HttpTest, ServesManyRequestsOnOneConnection) {
  TcpClient client(port);
  const std::string keep = "GET /healthz HTTP/1.1\r\n" + host + "\r\n";
  const std::string last = "GET /healthz HTTP/1.1\r\n" + host + "Connection: close\r\n\r\n";
  ASSERT_TRUE(client.send(keep + keep + last));  // pipelined
  bool closed = false;
  const std::string answers = client.read_to_end(closed);
  EXPECT_TRUE(closed);
  std::size_t count = 0;
  for (std::size_t at = 0; (at = answers.find("ok\n", at)) != std::string::npos; ++at) ++count;
  EXPECT_EQ(count, 3u);
}

TEST_F(HttpTest, HeadHasNoBody) {
  const HttpAnswer head =
      http(port, "HEAD /healthz HTTP/1.1\r\n" + host + "Connection: close\r\n\r\n");
  EXPECT_EQ(head.status, 200);
  EXPECT_EQ(head.headers.at("content-length"), "3");
  EXPECT_EQ(head.body, "");
}

TEST_F(HttpTest, WantsItsOwnName) {
  EXPECT_EQ(http(port, "GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n").status, 403);
  EXPECT_EQ(http(port, "GET / HTTP/1.1\r\n" + host + "Host: evil.example\r\n\r\n").status, 400);
  EXPECT_EQ(http(port, "GET / HTTP/1.1\r\n" + host + "Origin: http://" + server->address().text() +
                           "\r\nOrigin: http://evil.example\r\n\r\n")
                .status,
            403);
  EXPECT_EQ(http(port, "GET / HTTP/1.1\r\n\r\n").status, 400);
  EXPECT_EQ(http(port, "GET / HTTP/1.1\r\n" + host + "Origin: http://evil.example\r\n\r\n").status,
            403);
  EXPECT_EQ(
      http(port, "GET / HTTP/1.1\r\n" + host + "Origin: " + server->url() + "\r\n\r\n").status,
      200);
}

TEST_F(HttpTest, ABodyMayHaveSoMuchAndNotAByteMore) {
  const auto padded = [](std::size_t bytes) {
    std::string body = R"({"name":"a","note":")";
    body.append(bytes - body.size() - 2, 'x');
    return body + "\"}";
  };
  EXPECT_EQ(post(padded(kMaxBodyBytes)).status, 201);
  EXPECT_EQ(post(padded(kMaxBodyBytes + 1)).status, 413);
  // What only claims to be long is refused before it comes.
  EXPECT_EQ(http(port, "POST /api/maps HTTP/1.1\r\n" + host +
                           "Content-Type: application/json\r\nContent-Length: 99999999999\r\n\r\n")
                .status,
            413);
}

TEST_F(HttpTest, AHeaderMayNotBeEndless) {
  const std::string filler(20'000, 'x');
  EXPECT_EQ(http(port, "GET / HTTP/1.1\r\n" + host + "X: " + filler + "\r\n\r\n").status, 431);
}

TEST_F(HttpTest, WhatIsNoHttpIsAnswered) {
  EXPECT_EQ(http(port, "hello there\r\n\r\n").status, 400);
  EXPECT_EQ(http(port, "GET /healthz HTTP/1.1\r\nbad header\r\n\r\n").status, 400);
}

TEST_F(HttpTest, AsksForABodyThatWaitsToBeAskedFor) {
  TcpClient client(port);
  const std::string body = R"({"name":"patient"})";
  ASSERT_TRUE(client.send("POST /api/maps HTTP/1.1\r\n" + host +
                          "Content-Type: application/json\r\nExpect: 100-continue\r\n"
                          "Connection: close\r\nContent-Length: " +
                          std::to_string(body.size()) + "\r\n\r\n"));
  EXPECT_EQ(client.read_head(), "HTTP/1.1 100 Continue\r\n\r\n");
  ASSERT_TRUE(client.send(body));
  bool closed = false;
  const std::string answer = client.read_to_end(closed);
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 201")) << answer;
}

struct HastyHttpTest : HttpTest {
  HastyHttpTest() : HttpTest(options(300ms)) {}
};

TEST_F(HastyHttpTest, ATricklingRequestIsCutOff) {
  TcpClient client(port);
  // Bytes keep coming, of a header that would take minutes to become too long.
  bool open = client.send("GET /healthz HTTP/1.1\r\n" + host + "X: ");
  const auto deadline = std::chrono::steady_clock::now() + 60s;
  while (open && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(20ms);
    open = client.send("x");
  }
  EXPECT_FALSE(open);
}

TEST_F(HastyHttpTest, AConnectionThatSaysNothingIsClosed) {
  TcpClient client(port);
  bool closed = false;
  EXPECT_EQ(client.read_to_end(closed), "");
  EXPECT_TRUE(closed);
}

TEST_F(HttpTest, TooManyConnectionsAreTurnedAway) {
  ServerOptions few = options();
  few.limits.connections = 2;
  const auto small = Server::start(few).value();
  const std::uint16_t small_port = small->address().port;
  // The system hands connections over in the order in which they were made.
  TcpClient one(small_port), two(small_port), three(small_port);
  bool closed = false;
  // It is told at once, whatever it would have asked for.
  EXPECT_TRUE(three.read_head().starts_with("HTTP/1.1 503"));
  EXPECT_NE(three.read_to_end(closed).find("the server has 2, its most"), std::string::npos);
  EXPECT_TRUE(closed);

  const std::string last =
      "GET /healthz HTTP/1.1\r\nHost: " + small->address().text() + "\r\nConnection: close\r\n\r\n";
  for (TcpClient* admitted : {&one, &two}) {
    ASSERT_TRUE(admitted->send(last));
    EXPECT_TRUE(admitted->read_to_end(closed).ends_with("ok\n"));
  }
}

TEST_F(HttpTest, EndsQuicklyWithIdleConnectionsOpen) {
  TcpClient idle(port);
  ASSERT_TRUE(idle.send("GET /healthz HTTP/1.1\r\n" + host + "\r\n"));
  EXPECT_TRUE(idle.read_head().starts_with("HTTP/1.1 200"));
  const auto start = std::chrono::steady_clock::now();
  server->stop();
  // It would wait 3.5 s for one that does not end.
  EXPECT_LT(std::chrono::steady_clock::now() - start, 3s);
  bool closed = false;
  EXPECT_EQ(idle.read_to_end(closed), "ok\n");
  EXPECT_TRUE(closed);
}

}  // namespace
}  // namespace earthwork::net
