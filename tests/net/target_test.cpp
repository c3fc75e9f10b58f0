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
        "/api/./x", "/%2e%2e/etc", "/api%2Fmaps", "?x", "http://localhost/api"})
    EXPECT_FALSE(parse_target(text)) << text;
}

TEST(Target, LeavesTheQueryAsItIs) {
  EXPECT_EQ(parse_target("/x?a=%20../&b==")->asked("a"), "%20../");
  EXPECT_EQ(parse_target("/x?a=1&b==")->asked("b"), "=");
}

}  // namespace
}  // namespace earthwork::net
