// Authors: what was applied once is known again.
#include "server/room/authors.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <iterator>
#include <map>

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

}  // namespace
}  // namespace earthwork::room
