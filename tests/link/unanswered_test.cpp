// Edits that wait for an answer: their ids, their order, their bounds.
#include "client/link/unanswered.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace earthwork::link {
namespace {

using nlohmann::json;
using protocol::Code;
using protocol::MessageId;

protocol::Edit circle(std::size_t points = 1) {
  protocol::Edit edit;
  edit.is_path = points > 1;
  edit.path.assign(points, {123456.123456789, 123456.123456789});
  edit.radius = 3;
  return edit;
}

TEST(Unanswered, GivesIdsAndKeepsTheirOrder) {
  Unanswered edits;
  for (MessageId id = 1; id <= 3; ++id) {
    const auto kept = edits.add(circle());
    ASSERT_TRUE(kept);
    EXPECT_EQ(kept->id, id);
    EXPECT_EQ(json::parse(kept->message)["id"], id);
    EXPECT_EQ(json::parse(kept->message)["type"], "edit");
  }
  EXPECT_TRUE(edits.answer(2));
  EXPECT_FALSE(edits.answer(2));
  EXPECT_FALSE(edits.answer(4));
  EXPECT_EQ(edits.give_up(), (std::vector<MessageId>{1, 3}));
  EXPECT_TRUE(edits.edits().empty());
  EXPECT_EQ(edits.add(circle())->id, 4) << "no id is given twice";
}

TEST(Unanswered, GoesOnAfterTheIdsOfAnEarlierTime) {
  Unanswered edits(41);
  EXPECT_EQ(edits.add(circle())->id, 42);
}

TEST(Unanswered, KeepsAsManyAsAServerRemembers) {
  Unanswered edits;
  for (int i = 0; i < 4096; ++i) {
    EXPECT_FALSE(edits.full());
    ASSERT_TRUE(edits.add(circle()));
  }
  EXPECT_TRUE(edits.full());
  const auto refused = edits.add(circle());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::too_large);
  EXPECT_EQ(refused.error().detail,
            "edits wait that are beyond the limit of 4096 or of 2097152 bytes");
  EXPECT_TRUE(edits.answer(1));
  EXPECT_EQ(edits.add(circle())->id, 4097) << "a refused edit took no id";
}

TEST(Unanswered, KeepsOnlySoManyBytes) {
  Unanswered edits;
  std::size_t bytes = 0;
  while (!edits.full()) {
    const auto kept = edits.add(circle(1024));
    ASSERT_TRUE(kept);
    bytes += kept->message.size();
  }
  EXPECT_LE(bytes, 2'097'152u);
  EXPECT_GT(bytes, 2'097'152u - 65'536u);
  while (edits.add(circle(1024))) {
  }
  for (const MessageId id : std::vector<MessageId>{1, 2, 3}) EXPECT_TRUE(edits.answer(id));
  EXPECT_TRUE(edits.add(circle(1024)));
}

TEST(Unanswered, RefusesWhatAServerWouldRefuse) {
  Unanswered edits;
  const auto refused = edits.add(circle(20'000));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::too_large);
  EXPECT_NE(refused.error().detail.find("beyond the limit of 65536"), std::string::npos);
  EXPECT_EQ(edits.add(circle())->id, 1);
}

}  // namespace
}  // namespace earthwork::link
