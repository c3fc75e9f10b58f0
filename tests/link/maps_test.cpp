// The maps of a server: requests as INTERFACES has them, answers as values.
#include "client/link/maps.hpp"

#include <gtest/gtest.h>

#include "tests/link/fake_server.hpp"

namespace earthwork::link {
namespace {

using protocol::Code;

std::string answer(const std::string& status, const std::string& body) {
  return "HTTP/1.1 " + status + "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" +
         body;
}

TEST(Maps, MakesOneWithItsSettings) {
  std::string request;
  const FakeServer server(answer("201 Created", "{}"), &request);
  protocol::MapSettings settings;
  settings.chunk_resolution = 64;
  EXPECT_TRUE(create_map(server.address(), "demo", settings));
  EXPECT_TRUE(request.starts_with("POST /api/maps "));
  EXPECT_NE(request.find("\"name\":\"demo\""), std::string::npos);
  EXPECT_NE(request.find("\"chunk_resolution\":64"), std::string::npos);
}

TEST(Maps, TellsOneThatExists) {
  const FakeServer server(answer("409 Conflict", R"({"title":"map exists","detail":"demo"})"));
  const auto created = create_map(server.address(), "demo", {});
  ASSERT_FALSE(created);
  EXPECT_EQ(created.error().code, Code::map_exists);
  EXPECT_EQ(created.error().detail, server.address().text() + " answers 409: map exists: demo");
}

TEST(Maps, DescribesOne) {
  std::string request;
  const FakeServer server(
      answer("200 OK",
             R"({"name":"demo","settings":{"chunk_resolution":16},"epoch":"00","seq":7,"hash":"",)"
             R"("chunks":3,"users":2})"),
      &request);
  const auto info = map_info(server.address(), "demo");
  ASSERT_TRUE(info) << info.error().detail;
  EXPECT_EQ(info->seq, 7u);
  EXPECT_EQ(info->chunks, 3u);
  EXPECT_EQ(info->settings.chunk_resolution, 16);
  EXPECT_TRUE(request.starts_with("GET /api/maps/demo "));
}

TEST(Maps, TellsOneThatIsMissing) {
  const FakeServer server(answer("404 Not Found", "plain text"));
  const auto info = map_info(server.address(), "demo");
  ASSERT_FALSE(info);
  EXPECT_EQ(info.error().code, Code::unknown_map);
  EXPECT_EQ(info.error().detail, server.address().text() + " answers 404");
}

TEST(Maps, RefusesAnAnswerThatDescribesNoMap) {
  const FakeServer server(answer("200 OK", R"({"seq":"seven"})"));
  const auto info = map_info(server.address(), "demo");
  ASSERT_FALSE(info);
  EXPECT_NE(info.error().detail.find("sent no map's description: seq"), std::string::npos);
}

TEST(Maps, AsksNothingForANameThatIsNone) {
  const auto info = map_info(nobody(), "../etc");
  ASSERT_FALSE(info);
  EXPECT_EQ(info.error().code, Code::bad_name);
}

}  // namespace
}  // namespace earthwork::link
