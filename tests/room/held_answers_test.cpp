// Answers that wait for what makes them true, in their order.
#include "server/room/held_answers.hpp"

#include <gtest/gtest.h>

namespace earthwork::room {
namespace {

using protocol::Applied;
using protocol::Code;
using protocol::Rejected;

const protocol::Failure kLate{Code::id_out_of_order, "late", "id"};
const protocol::Failure kFull{Code::disk_full, "full", {}};

std::uint64_t seq_of(const Reply& reply) { return std::get<Applied>(reply).seq; }

TEST(HeldAnswers, GoWhenTheirSeqIsDurable) {
  HeldAnswers held;
  EXPECT_TRUE(held.take(9).empty());
  held.add(Applied{1, 4}, 4), held.add(Applied{2, 5}, 5), held.add(Applied{3, 6}, 6);
  EXPECT_TRUE(held.take(3).empty());
  const auto first = held.take(5);
  ASSERT_EQ(first.size(), 2u);
  EXPECT_EQ(seq_of(first[0]), 4u);
  EXPECT_EQ(seq_of(first[1]), 5u);
  EXPECT_EQ(held.take(6).size(), 1u);
  EXPECT_TRUE(held.take(6).empty());
}

TEST(HeldAnswers, NoneOvertakesAnother) {
  HeldAnswers held;
  held.add(Applied{5, 7}, 7), held.add(Applied{1, 2}, 2), held.add(Rejected{4, kLate}, 7);
  EXPECT_TRUE(held.take(6).empty());
  const auto all = held.take(7);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(seq_of(all[1]), 2u);
  EXPECT_EQ(std::get<Rejected>(all[2]).failure, kLate);
}

TEST(HeldAnswers, WhatWillNotBeTrueIsRefusedInItsPlace) {
  HeldAnswers held;
  held.add(Applied{5, 7}, 7), held.add(Applied{1, 2}, 2), held.add(Rejected{4, kLate}, 7);
  held.refuse(6, kFull);
  const auto all = held.take(6);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(std::get<Rejected>(all[0]), (Rejected{5, kFull}));
  EXPECT_EQ(seq_of(all[1]), 2u);  // that one is durable
  EXPECT_EQ(std::get<Rejected>(all[2]), (Rejected{4, kFull}));
}

}  // namespace
}  // namespace earthwork::room
