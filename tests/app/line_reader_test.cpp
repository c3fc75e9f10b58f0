// Lines of a file, one at a time, none of them too long.
#include "server/app/line_reader.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace earthwork::app {
namespace {

using Lines = std::vector<std::pair<std::uint64_t, std::string>>;

Lines lines_of(const std::string& text) {
  std::istringstream in(text);
  LineReader reader(in);
  Lines lines;
  for (auto line = reader.next(); line.has_value() && line->has_value(); line = reader.next())
    lines.emplace_back(reader.number(), **line);
  return lines;
}

TEST(LineReader, GivesLinesWithTheirNumbers) {
  EXPECT_EQ(lines_of("a\n\n b\r\n\t \r\nc"), (Lines{{1, "a"}, {3, " b"}, {5, "c"}}));
  EXPECT_EQ(lines_of("a\n"), (Lines{{1, "a"}}));
  EXPECT_EQ(lines_of(""), Lines{});
  EXPECT_EQ(lines_of("\n\n"), Lines{});
  EXPECT_EQ(lines_of(std::string("a\0b\n", 4)), (Lines{{1, std::string("a\0b", 3)}}));
}

TEST(LineReader, TakesALineAtTheLimit) {
  const std::string longest(protocol::kMaxControlBytes, 'x');
  EXPECT_EQ(lines_of(longest + "\r\n" + longest), (Lines{{1, longest}, {2, longest}}));
}

TEST(LineReader, RefusesALongerOne) {
  std::istringstream in("a\n" + std::string(protocol::kMaxControlBytes + 2, 'x') + "\n");
  LineReader reader(in);
  EXPECT_TRUE(reader.next());
  const auto refused = reader.next();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, protocol::Code::too_large);
  EXPECT_EQ(refused.error().detail, "longer than the limit of 65536 bytes");
  EXPECT_EQ(reader.number(), 2u);
}

TEST(LineReader, NoticesAFileThatCannotBeRead) {
  std::ifstream folder("/", std::ios::binary);
  LineReader reader(folder);
  EXPECT_EQ(reader.next().error().code, protocol::Code::storage_failed);
}

}  // namespace
}  // namespace earthwork::app
