// HTTP: what is asked, what is answered, and what is not.
#include "client/link/http_client.hpp"

#include <gtest/gtest.h>

#include "tests/link/fake_server.hpp"

namespace earthwork::link {
namespace {

using namespace std::chrono_literals;

constexpr const char* kHello =
    "HTTP/1.1 200 OK\r\nContent-Type: text/plain\r\nETag: \"v1\"\r\nContent-Length: 5\r\n\r\nhello";

TEST(HttpClient, GetsABodyWithItsTypeAndTag) {
  std::string request;
  const FakeServer server(kHello, &request);
  const auto answer = http_get(server.address(), "/api/maps?x=1");
  ASSERT_TRUE(answer) << answer.error().detail;
  EXPECT_EQ(answer->status, 200);
  EXPECT_EQ(answer->type, "text/plain");
  EXPECT_EQ(answer->etag, "\"v1\"");
  EXPECT_EQ(answer->body, "hello");
  EXPECT_TRUE(request.starts_with("GET /api/maps?x=1 HTTP/1.1\r\n"));
  EXPECT_NE(request.find("Host: " + server.address().host_header() + "\r\n"), std::string::npos);
}

TEST(HttpClient, PostsJson) {
  std::string request;
  const FakeServer server("HTTP/1.1 201 Created\r\nContent-Length: 0\r\n\r\n", &request);
  const auto answer = http_post(server.address(), "/api/maps", "{}");
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 201);
  EXPECT_TRUE(request.starts_with("POST /api/maps HTTP/1.1\r\n"));
  EXPECT_NE(request.find("Content-Type: application/json\r\n"), std::string::npos);
  EXPECT_TRUE(request.ends_with("\r\n\r\n{}"));
}

TEST(HttpClient, GivesBackRefusalsAsAnswers) {
  const FakeServer server("HTTP/1.1 404 Not Found\r\nContent-Length: 2\r\n\r\nno");
  const auto answer = http_get(server.address(), "/");
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 404);
  EXPECT_EQ(answer->body, "no");
}

TEST(HttpClient, TakesABodyUpToTheBound) {
  const FakeServer server(kHello);
  EXPECT_TRUE(http_get(server.address(), "/", {.max_body_bytes = 5}));
  const auto answer = http_get(server.address(), "/", {.max_body_bytes = 4});
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, protocol::Code::too_large);
  EXPECT_EQ(answer.error().detail, server.address().text() + " answers with more than 4 bytes");
}

TEST(HttpClient, NamesAServerThatIsNotThere) {
  const ServerAddress address = nobody();
  const auto answer = http_get(address, "/");
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().detail, address.text() + " cannot be reached: Connection refused");
}

TEST(HttpClient, DoesNotWaitForEver) {
  const FakeServer server("");
  const auto answer = http_get(server.address(), "/", {.timeout = 50ms});
  ASSERT_FALSE(answer);
  EXPECT_NE(answer.error().detail.find("cannot be reached"), std::string::npos);
}

TEST(HttpClient, RefusesWhatIsNotHttp) {
  const FakeServer server("220 mail.example ESMTP\r\n");
  EXPECT_FALSE(http_get(server.address(), "/"));
}

}  // namespace
}  // namespace earthwork::link
