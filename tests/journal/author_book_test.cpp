// What is remembered of authors: the last ids of each, and no more.
#include "server/journal/author_book.hpp"

#include <gtest/gtest.h>

#include "protocol/limits.hpp"

namespace earthwork::journal {
namespace {

TEST(AuthorBook, KeepsAuthorsInOrder) {
  AuthorBook book;
  EXPECT_TRUE(book.add(9, {1, 1}));
  EXPECT_TRUE(book.add(3, {5, 2}));
  EXPECT_TRUE(book.add(9, {2, 3}));
  EXPECT_EQ(book.states(), (std::vector<AuthorState>{{3, {{5, 2}}}, {9, {{1, 1}, {2, 3}}}}));
  EXPECT_EQ(book.of(9).size(), 2u);
  EXPECT_TRUE(book.of(4).empty());
}

TEST(AuthorBook, TakesOnlyWhatIsAboveTheLast) {
  AuthorBook book({{9, {{4, 10}}}}, 10);
  EXPECT_FALSE(book.add(9, {4, 11}));
  EXPECT_FALSE(book.add(9, {3, 11}));
  EXPECT_FALSE(book.add(9, {5, 10}));
  EXPECT_TRUE(book.add(9, {5, 11}));
  EXPECT_FALSE(book.add(8, {0, 1}));
  EXPECT_FALSE(book.add(8, {protocol::kMaxInteger + 1, 1}));
  EXPECT_TRUE(book.of(8).empty());
  EXPECT_EQ(book.states().size(), 1u);
  EXPECT_TRUE(book.add(8, {1, 1}));
}

TEST(AuthorBook, LeavesOutWhatCameLater) {
  const AuthorBook book({{9, {{4, 10}, {5, 12}}}, {8, {{1, 12}}}}, 11);
  EXPECT_EQ(book.states(), (std::vector<AuthorState>{{9, {{4, 10}}}}));
}

TEST(AuthorBook, RemembersTheLastIds) {
  AuthorBook book;
  constexpr std::uint64_t kCount = 3 * protocol::kMaxRememberedIds + 7;
  for (std::uint64_t seq = 1; seq <= kCount; ++seq) {
    ASSERT_TRUE(book.add(9, {static_cast<std::int64_t>(2 * seq), seq}));
    const auto last = book.of(9);
    ASSERT_EQ(last.size(), std::min<std::size_t>(seq, protocol::kMaxRememberedIds));
    ASSERT_EQ(last.back().seq, seq);
    ASSERT_EQ(last.front().seq, seq + 1 - last.size());
  }
  EXPECT_EQ(book.states()[0].applied.size(), 4096u);
}

}  // namespace
}  // namespace earthwork::journal
