// From edits in line to events: whose turn it is, who is known again, and what is taken back.
#include "server/room/edit_desk.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "server/history/fold.hpp"
#include "tests/room/onlooker.hpp"

namespace earthwork::room {
namespace {

using protocol::Applied;
using protocol::Code;
using protocol::Rejected;

struct EditDeskTest : testing::Test {
  struct Answer {
    ViewerId viewer;
    Reply reply;
    std::uint64_t seq;
  };
  void ask(std::uint64_t author, protocol::MessageId id, protocol::Edit edit) {
    const std::uint64_t cost = rows_visited(edit, settings);
    ASSERT_TRUE(
        desk.push({.viewer = author, .command = {id, author, std::move(edit)}, .cost = cost}));
  }
  static protocol::Edit large() {  // 1,000 stamps over 7 x 7 chunks each
    protocol::Edit edit = disc(0, 0, 20);
    edit.is_path = true;
    for (int i = 1; i < 1000; ++i) edit.path.push_back({i / 16.0, 0});
    return edit;
  }
  const protocol::Failure kFull{Code::disk_full, "full", {}};

  protocol::MapSettings settings{.chunk_resolution = 8, .chunks = {}};
  voxel::Map map = history::make_map(settings);
  std::shared_ptr<Meters> meters = std::make_shared<Meters>();
  std::uint64_t seq = 10;
  std::size_t most = 1'000'000;
  std::vector<Answer> answers;
  std::vector<std::pair<std::uint64_t, protocol::MessageId>> events;  // author, id
  SettingsBook book{settings};
  EditDesk desk{{map, book},
                Commits::later,
                {},
                10,
                meters,
                {.applied =
                     [this](Command& command, const voxel::Change&) {
                       events.emplace_back(command.author, command.id);
                       return ++seq;
                     },
                 .answered =
                     [this](ViewerId viewer, Reply reply, std::uint64_t true_at) {
                       answers.push_back({viewer, std::move(reply), true_at});
                     },
                 .full = [this] { return events.size() >= most; }}};
};

TEST_F(EditDeskTest, AnAppliedEditIsAnsweredOnceItsSeqIsDurable) {
  ask(7, 1, disc(4, 4, 2));
  desk.take_turn();
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(answers[0].viewer, 7u);
  EXPECT_EQ(std::get<Applied>(answers[0].reply), (Applied{1, 11}));
  EXPECT_EQ(answers[0].seq, 11u);
  EXPECT_GT(map.chunk_count(), 0u);
  EXPECT_FALSE(desk.has_next());
}

TEST_F(EditDeskTest, ARepeatedOneOnceTheFirstIsARefusalOnceAllIs) {
  ask(7, 5, disc(4, 4, 2)), ask(8, 1, disc(9, 4, 2));
  desk.take_turn();
  ask(7, 5, disc(4, 4, 2)), ask(7, 4, disc(4, 4, 2));
  desk.take_turn();
  ASSERT_EQ(answers.size(), 4u);
  const std::uint64_t first = std::get<Applied>(answers[2].reply).seq;
  EXPECT_EQ(answers[2].seq, first);
  EXPECT_EQ(std::get<Rejected>(answers[3].reply).failure.code, Code::id_out_of_order);
  EXPECT_EQ(answers[3].seq, 12u);
  EXPECT_EQ(meters->repeated, 1u);
  EXPECT_EQ(events.size(), 2u);
}

TEST_F(EditDeskTest, ATurnTakesSoManyAndStopsWhenThereIsNoRoom) {
  for (int id = 1; id <= 600; ++id) ask(7, id, disc(4, 4, 0));
  most = 100;
  desk.take_turn();
  EXPECT_EQ(events.size(), 100u);
  EXPECT_TRUE(desk.has_next());
  most = 1'000'000;
  desk.take_turn();
  EXPECT_EQ(events.size(), 600u);
  for (int id = 601; id <= 1200; ++id) ask(7, id, disc(4, 4, 0));
  desk.take_turn();
  EXPECT_EQ(events.size(), 1112u);
  EXPECT_EQ(desk.line().size(), 88u);
}

TEST_F(EditDeskTest, ALargeOneIsAppliedInTheTurnAfterItsPreparation) {
  ask(7, 1, large()), ask(8, 1, disc(500, 500, 2));
  desk.take_turn();
  EXPECT_TRUE(desk.preparing());
  EXPECT_EQ(events.size(), 1u);
  while (desk.preparing()) desk.prepare();
  EXPECT_EQ(events.size(), 1u);
  desk.take_turn();
  EXPECT_EQ(events.size(), 2u);
  EXPECT_EQ(desk.line().size(), 0u);
}

TEST_F(EditDeskTest, TakesBackWhatIsNotDurableAndRefusesTheLine) {
  ask(7, 1, disc(4, 4, 2));
  desk.take_turn();
  desk.handed_over();
  const std::uint64_t hash = map.hash();
  ask(7, 2, disc(9, 4, 2));
  desk.take_turn();
  desk.durable(11);
  desk.handed_over();
  ask(7, 3, large()), ask(7, 4, disc(4, 4, 1)), ask(8, 1, disc(90, 4, 2));
  desk.take_turn();
  ASSERT_TRUE(desk.preparing());
  answers.clear();
  desk.take_back(kFull);

  EXPECT_EQ(map.hash(), hash);
  EXPECT_FALSE(desk.preparing());
  EXPECT_FALSE(desk.has_next());
  ASSERT_EQ(answers.size(), 2u);  // 8's was applied
  EXPECT_EQ(std::get<Rejected>(answers[0].reply), (Rejected{3, kFull}));
  EXPECT_EQ(std::get<Rejected>(answers[1].reply), (Rejected{4, kFull}));
  EXPECT_EQ(answers[1].seq, 11u);
  EXPECT_EQ(desk.authors().judge(7, 1).standing, Authors::Standing::repeated);
  EXPECT_EQ(desk.authors().judge(7, 2).standing, Authors::Standing::fresh);
  EXPECT_EQ(desk.authors().judge(8, 1).standing, Authors::Standing::fresh);
}

TEST_F(EditDeskTest, MayBeClearedInTheMidstOfAPreparation) {
  ask(7, 1, large()), ask(8, 1, large());
  desk.take_turn();
  desk.clear();
  EXPECT_FALSE(desk.preparing());
  EXPECT_TRUE(desk.line().empty());
  desk.take_turn();
  EXPECT_TRUE(events.empty() && answers.empty());
}

}  // namespace
}  // namespace earthwork::room
