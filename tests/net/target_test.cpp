// Request targets: plain paths, plain queries, nothing clever.
#include "server/net/target.hpp"

#include <gtest/gtest.h>

namespace earthwork::net {
namespace {

using Segments = std::vector<std::string>;

TEST(Target, IsTakenApart) {
  const auto target = parse_target("/api/maps/a_b-1/export.glb?seq=12&x=&y&seq=13");
  ASSERT_TRUE(target);
  EXPECT_EQ(target->segments, (Segments{"api", "maps", "a_b-1", "export.glb"}));
  EXPECT_EQ(target->asked("seq"), "13");
  EXPECT_EQ(target->asked("x"), "");
  EXPECT_EQ(target->asked("y"), "");
  EXPECT_EQ(target->asked("z"), std::nullopt);
}

TEST(Target, OfTheRootHasNoSegments) {
  EXPECT_EQ(parse_target("/")->segments, Segments{});
  EXPECT_EQ(parse_target("/?a=b")->segments, Segments{});
}

TEST(Target, ThatLeadsAsideIsNone) {
  for (const char* text :
       {"", "api", "*", "//", "/api/", "/api//maps", "/..", "/../etc/passwd", "/api/../x",
        "/api/./x", "/%2e%2e/etc", "/api%2Fmaps", "?x", "https://localhost/api", "ftp://x/",
        "http:/x", "http://x/../y", "http://x/%2e", "xhttp://x/"})
    EXPECT_FALSE(parse_target(text)) << text;
}

TEST(Target, MayBeAWholeUrl) {
  const auto target = parse_target("HTTP://Maps.example:80/api/maps?x=http://y/");
  ASSERT_TRUE(target);
  EXPECT_EQ(target->authority, "Maps.example:80");
  EXPECT_EQ(target->segments, (Segments{"api", "maps"}));
  EXPECT_EQ(target->asked("x"), "http://y/");
  EXPECT_EQ(parse_target("/api")->authority, std::nullopt);
}

TEST(Target, OfAUrlWithoutAPathIsTheRoot) {
  for (const char* text : {"http://a", "http://a/", "http://a?x=1"}) {
    const auto target = parse_target(text);
    ASSERT_TRUE(target) << text;
    EXPECT_EQ(target->authority, "a");
    EXPECT_EQ(target->segments, Segments{});
  }
  EXPECT_EQ(parse_target("http://a?x=1")->asked("x"), "1");
  EXPECT_EQ(parse_target("http:///x")->authority, "");  // which is no name of any server
}

TEST(Target, LeavesTheQueryAsItIs) {
  EXPECT_EQ(parse_target("/x?a=%20../&b==")->asked("a"), "%20../");
  EXPECT_EQ(parse_target("/x?a=1&b==")->asked("b"), "=");
}

}  // namespace
}  // namespace earthwork::net
