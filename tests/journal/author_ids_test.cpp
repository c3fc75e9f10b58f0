// What is remembered of an author: one form in bytes, and nothing from any other.
#include "server/journal/author_ids.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "protocol/limits.hpp"

namespace earthwork::journal {
namespace {

using namespace std::string_literals;
using Applied = AuthorState::Applied;

std::optional<std::vector<Applied>> decoded(std::string_view bytes) {
  return decode_ids(std::as_bytes(std::span(bytes)));
}

TEST(AuthorIds, AreStepsOfSevenBits) {
  const std::vector<Applied> ids{{5, 300}, {6, 301}};
  EXPECT_EQ(encode_ids(ids), "\x05\xAC\x02\x01\x01");
  EXPECT_EQ(decoded("\x05\xAC\x02\x01\x01"), ids);
  EXPECT_EQ(decoded(""), std::vector<Applied>{});
}

TEST(AuthorIds, AreRefusedWhenTheyAreNotTheOneForm) {
  EXPECT_FALSE(decoded("\x05")) << "an id without its seq";
  EXPECT_FALSE(decoded("\x05\xAC")) << "cut off";
  EXPECT_FALSE(decoded("\x05\0"s)) << "no step";
  EXPECT_FALSE(decoded("\x85\0\x01"s)) << "longer than need be";
  EXPECT_FALSE(decoded(std::string(20, '\xFF')));
}

TEST(AuthorIds, EndWithTheirLimits) {
  const std::vector<Applied> last{{protocol::kMaxInteger, protocol::kMaxInteger}};
  EXPECT_EQ(decoded(encode_ids(last)), last);
  EXPECT_FALSE(decoded(encode_ids(last) + "\x01\x01"));
  std::string many;
  for (std::size_t i = 0; i < protocol::kMaxRememberedIds; ++i) many += "\x01\x01";
  ASSERT_TRUE(decoded(many));
  EXPECT_EQ(decoded(many)->size(), 4096u);
  EXPECT_FALSE(decoded(many + "\x01\x01"));
}

RC_GTEST_PROP(AuthorIds, GiveTheSameBack, ()) {
  std::vector<Applied> ids;
  Applied last;
  for (const int bits : *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 44))) {
    last.id += *rc::gen::inRange<std::int64_t>(1, (std::int64_t{1} << bits) + 1);
    last.seq += *rc::gen::inRange<std::uint64_t>(1, (std::uint64_t{1} << bits) + 1);
    ids.push_back(last);
  }
  RC_ASSERT(decoded(encode_ids(ids)) == ids);
}

RC_GTEST_PROP(AuthorIds, ThatAreReadAreThoseThatAreWritten, ()) {
  const auto bytes = *rc::gen::container<std::string>(
      rc::gen::element('\x01', '\x7F', '\x80', '\x81', '\0', '\xFF', '\x02'));
  const auto ids = decoded(bytes);
  if (ids) RC_ASSERT(encode_ids(*ids) == bytes);
}

}  // namespace
}  // namespace earthwork::journal
