// Asking every map how much waits in it.
#include "server/net/survey.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "server/room/manual_context.hpp"
#include "tests/room/atlas_calls.hpp"

namespace earthwork::net {
namespace {

struct SurveyTest : testing::Test {
  struct Blind final : room::Viewer {
    void answered(std::vector<room::Reply>) override {}
    void deliver(room::Parcel) override {}
    void tell(room::Talk) override {}
    void settings(room::SharedText) override {}
    void end(protocol::Bye) override {}
  };

  std::shared_ptr<room::Room> map(const std::string& name) {
    return room::create_map(atlas, name, {}).value();
  }
  room::ViewerId enter(room::Room& room) {
    return room.join(std::make_shared<Blind>(), {}).value().viewer;
  }
  void submit(room::Room& room, room::ViewerId viewer, protocol::MessageId id) {
    ASSERT_TRUE(room.submit(
        viewer, {.id = id,
                 .author = 1,
                 .action = protocol::Edit{.radius = 3, .path = {{10, 10}}, .stroke = {}}}));
  }
  Survey::Told note() {
    return [this](const MapTotals& totals) { told.push_back(totals); };
  }

  room::ManualContext context;
  room::Atlas atlas{{.make_strand = [this] { return context.make_strand(); }}};
  std::shared_ptr<Survey> survey = std::make_shared<Survey>(atlas);
  std::vector<MapTotals> told;
};

TEST_F(SurveyTest, OfNoMapsIsToldAtOnce) {
  survey->ask(note());
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].maps, 0u);
  EXPECT_EQ(told[0].waiting_edits, 0u);
}

TEST_F(SurveyTest, AddsTheMapsUp) {
  const auto a = map("a"), b = map("b");
  map("c");
  const auto painter = enter(*a), other = enter(*b);
  enter(*b);
  context.run();
  submit(*b, other, 1);  // two in line, where the survey comes before the turn that applies them
  submit(*b, other, 2);
  submit(*a, painter, 1);
  survey->ask(note());
  EXPECT_TRUE(told.empty());
  context.run();
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].maps, 3u);
  EXPECT_EQ(told[0].viewers, 3u);

  survey->ask(note());
  context.run();
  ASSERT_EQ(told.size(), 2u);
  EXPECT_EQ(told[1].waiting_edits, 0u);
}

TEST_F(SurveyTest, SumsAndTakesTheLongestWait) {
  MapTotals totals;
  totals.add({.waiting_edits = 2,
              .oldest_wait_ms = 30,
              .owed_chunks = 5,
              .dirty_chunks = 7,
              .viewers = 1});
  totals.add({.waiting_edits = 3,
              .oldest_wait_ms = 20,
              .owed_chunks = 6,
              .dirty_chunks = 8,
              .viewers = 4});
  EXPECT_EQ(totals.waiting_edits, 5u);
  EXPECT_EQ(totals.oldest_wait_ms, 30);
  EXPECT_EQ(totals.owed_chunks, 11u);
  EXPECT_EQ(totals.dirty_chunks, 15u);
  EXPECT_EQ(totals.viewers, 5u);
}

TEST_F(SurveyTest, HoweverManyAskAMapIsAskedOnceAtATime) {
  std::size_t strands = 0, tasks = 0;
  struct Counted final : room::Strand {
    std::unique_ptr<room::Strand> inner;
    std::size_t* tasks;
    Counted(std::unique_ptr<room::Strand> strand, std::size_t* count)
        : inner(std::move(strand)), tasks(count) {}
    void post(Task task) override {
      ++*tasks;
      inner->post(std::move(task));
    }
    void post_aside(Task task) override { inner->post_aside(std::move(task)); }
    void post_after(std::chrono::milliseconds delay, Task task) override {
      inner->post_after(delay, std::move(task));
    }
    [[nodiscard]] std::int64_t now_ms() const override { return inner->now_ms(); }
  };
  room::Atlas counted({.make_strand = [&] {
    ++strands;
    return std::make_unique<Counted>(context.make_strand(), &tasks);
  }});
  ASSERT_TRUE(room::create_map(counted, "a", {}));
  ASSERT_TRUE(room::create_map(counted, "b", {}));
  const auto asked = std::make_shared<Survey>(counted);
  tasks = 0;
  for (int i = 0; i < 100; ++i) asked->ask(note());
  EXPECT_EQ(strands, 2u);
  EXPECT_EQ(tasks, 2u);
  context.run();
  EXPECT_EQ(told.size(), 100u);
  asked->ask(note());  // a new round
  EXPECT_EQ(tasks, 4u);
  context.run();
  EXPECT_EQ(told.size(), 101u);
}

TEST_F(SurveyTest, AMapThatIsDeletedMeanwhileIsCountedAllTheSame) {
  map("a");
  survey->ask(note());
  room::erase_map(atlas, "a");
  context.run();
  EXPECT_EQ(told.size(), 1u);
}

}  // namespace
}  // namespace earthwork::net
