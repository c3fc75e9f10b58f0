// Authors: what was applied once is known again.
#include "server/room/authors.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <iterator>
#include <map>
#include <vector>

namespace earthwork::room {
namespace {

using Standing = Authors::Standing;
using Verdict = Authors::Verdict;

TEST(Authors, TakeTheFirstIdWhateverItIs) {
  const Authors authors;
  EXPECT_EQ(authors.judge(7, 1), (Verdict{Standing::fresh, 0}));
  EXPECT_EQ(authors.judge(7, 9007199254740991), (Verdict{Standing::fresh, 0}));
}

TEST(Authors, KnowAnIdAgain) {
  Authors authors;
  authors.applied(7, 3, 100);
  authors.applied(7, 9, 105);
  EXPECT_EQ(authors.judge(7, 3), (Verdict{Standing::repeated, 100}));
  EXPECT_EQ(authors.judge(7, 9), (Verdict{Standing::repeated, 105}));
  EXPECT_EQ(authors.judge(7, 10), (Verdict{Standing::fresh, 0}));
}

TEST(Authors, RefuseAnIdBelowOneThatWasApplied) {
  Authors authors;
  authors.applied(7, 3, 100);
  authors.applied(7, 9, 105);
  EXPECT_EQ(authors.judge(7, 5), (Verdict{Standing::out_of_order, 0}));
  EXPECT_EQ(authors.judge(7, 1), (Verdict{Standing::out_of_order, 0}));
}

TEST(Authors, AreIndependent) {
  Authors authors;
  authors.applied(7, 3, 100);
  EXPECT_EQ(authors.judge(8, 3).standing, Standing::fresh);
  EXPECT_EQ(authors.judge(8, 1).standing, Standing::fresh);
}

TEST(Authors, RememberSoManyAndNotOneMore) {
  Authors authors;
  for (int n = 1; n <= 4095; ++n) authors.applied(7, 2 * n, static_cast<std::uint64_t>(n));
  EXPECT_EQ(authors.judge(7, 1).standing, Standing::out_of_order);
  authors.applied(7, 8192, 4096);
  EXPECT_EQ(authors.judge(7, 2), (Verdict{Standing::repeated, 1}));
  EXPECT_EQ(authors.judge(7, 1).standing, Standing::too_old);

  authors.applied(7, 8194, 4097);
  EXPECT_EQ(authors.judge(7, 2).standing, Standing::too_old);
  EXPECT_EQ(authors.judge(7, 3).standing, Standing::too_old);
  EXPECT_EQ(authors.judge(7, 4), (Verdict{Standing::repeated, 2}));
  EXPECT_EQ(authors.judge(7, 5).standing, Standing::out_of_order);
  EXPECT_EQ(authors.judge(7, 8194), (Verdict{Standing::repeated, 4097}));
  EXPECT_EQ(authors.judge(7, 8195).standing, Standing::fresh);
}

TEST(Authors, AgreeWithAListOfEverything) {
  EXPECT_TRUE(rc::check([] {
    Authors authors;
    std::map<protocol::MessageId, std::uint64_t> all;
    const int count = *rc::gen::weightedOneOf<int>(
        {{3, rc::gen::inRange(0, 20)}, {1, rc::gen::inRange(4090, 9000)}});
    protocol::MessageId id = 0;
    for (int n = 1; n <= count; ++n) {
      id += 1 + n % 3;
      authors.applied(7, id, static_cast<std::uint64_t>(n));
      all[id] = static_cast<std::uint64_t>(n);
    }
    const auto asked = *rc::gen::inRange<protocol::MessageId>(1, id + 3);
    const Verdict verdict = authors.judge(7, asked);
    const auto known = all.find(asked);
    if (asked > id) {
      RC_ASSERT(verdict.standing == Standing::fresh);
    } else if (known != all.end() && std::distance(known, all.end()) <= 4096) {
      RC_ASSERT(verdict == (Verdict{Standing::repeated, known->second}));
    } else {
      const auto larger = std::distance(all.upper_bound(asked), all.end());
      RC_ASSERT(verdict.standing == (larger >= 4096 ? Standing::too_old : Standing::out_of_order));
    }
  }));
}

journal::AuthorState state_of(std::uint64_t author, protocol::MessageId first, int count) {
  journal::AuthorState state{.author = author, .applied = {}};
  for (int n = 0; n < count; ++n)
    state.applied.push_back({first + n, 100 + static_cast<std::uint64_t>(n)});
  return state;
}

TEST(Authors, AreWhatTheyWereLeftAs) {
  const std::vector<journal::AuthorState> left{state_of(7, 3, 2), state_of(8, 1, 4096),
                                               state_of(9, 1, 0)};
  Authors authors(left);
  EXPECT_EQ(authors.judge(7, 4), (Verdict{Standing::repeated, 101}));
  EXPECT_EQ(authors.judge(7, 5).standing, Standing::fresh);
  EXPECT_EQ(authors.judge(8, 1), (Verdict{Standing::repeated, 100}));
  EXPECT_EQ(authors.judge(9, 1).standing, Standing::fresh);
  authors.applied(8, 4097, 9000);
  EXPECT_EQ(authors.judge(8, 1).standing, Standing::too_old);
  EXPECT_EQ(authors.state(7), left[0]);
  EXPECT_EQ(authors.state(9), left[2]);
  EXPECT_EQ(authors.state(8).applied.size(), 4096u);
  EXPECT_EQ(authors.state(8).applied.front().id, 2);
  EXPECT_EQ(authors.state(8).applied.back().seq, 9000u);
}

TEST(Authors, WhoIsLeftWithTooManyIdsKeepsTheLast) {
  const std::vector<journal::AuthorState> left{state_of(7, 1, 4097)};
  const Authors authors(left);
  EXPECT_EQ(authors.judge(7, 1).standing, Standing::too_old);
  EXPECT_EQ(authors.judge(7, 2), (Verdict{Standing::repeated, 101}));
}

TEST(Authors, ForgetWhatIsTakenBackAndNothingElse) {
  Authors authors;
  authors.applied(7, 1, 10), authors.applied(7, 5, 11), authors.applied(8, 1, 12);
  authors.keep(10);
  authors.take_back();
  EXPECT_EQ(authors.judge(7, 1), (Verdict{Standing::repeated, 10}));
  EXPECT_EQ(authors.judge(7, 5).standing, Standing::fresh);
  EXPECT_EQ(authors.judge(7, 4).standing, Standing::fresh);
  EXPECT_EQ(authors.judge(8, 1).standing, Standing::fresh);
  EXPECT_TRUE(authors.state(8).applied.empty());
}

TEST(Authors, AreAfterTakingBackWhatTheyWereBefore) {
  EXPECT_TRUE(rc::check([] {
    const int count = *rc::gen::element(0, 1, 4090, 4096);
    const std::vector<journal::AuthorState> left{state_of(7, 1, count)};
    Authors authors(left);
    std::uint64_t seq = 10'000;
    protocol::MessageId id = count;
    auto kept = authors.state(7);
    for (int rounds = *rc::gen::inRange(1, 6); rounds > 0; --rounds) {
      for (int n = *rc::gen::inRange(0, 30); n > 0; --n) authors.applied(7, ++id, ++seq);
      if (*rc::gen::arbitrary<bool>()) {
        authors.keep(seq);
        kept = authors.state(7);
      }
      if (*rc::gen::arbitrary<bool>()) {
        authors.take_back();
        RC_ASSERT(authors.state(7) == kept);
        id = kept.applied.empty() ? 0 : kept.applied.back().id;
      }
    }
    authors.take_back();
    RC_ASSERT(authors.state(7) == kept);
  }));
}

}  // namespace
}  // namespace earthwork::room
