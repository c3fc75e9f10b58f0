// If-None-Match, as browsers and scripts write it.
#include "server/net/entity_tag.hpp"

#include <gtest/gtest.h>

namespace earthwork::net {
namespace {

TEST(GlbExport, IfNoneMatchIsAList) {
  EXPECT_TRUE(names_tag("\"a\"", "\"a\""));
  EXPECT_TRUE(names_tag("\"b\", \"a\"", "\"a\""));
  EXPECT_TRUE(names_tag(" W/\"a\" ,\"b\"", "\"a\""));
  EXPECT_TRUE(names_tag("*", "\"a\""));
  EXPECT_FALSE(names_tag("\"aa\"", "\"a\""));
  EXPECT_FALSE(names_tag("a", "\"a\""));
  EXPECT_FALSE(names_tag("", "\"a\""));
  EXPECT_FALSE(names_tag(" , ,", "\"a\""));
}

}  // namespace
}  // namespace earthwork::net
