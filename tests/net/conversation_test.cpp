// What is said in a session: every state, every message, every refusal; without a socket.
#include "server/net/conversation.hpp"

#include <gtest/gtest.h>

#include "server/room/manual_context.hpp"
#include "tests/net/speaker.hpp"
#include "tests/room/atlas_calls.hpp"
#include "tests/room/kept_shelf.hpp"

namespace earthwork::net {
namespace {

using protocol::Code;

const std::string kEdit =
    R"({"type":"edit","id":4,"stencil":"circle","fill":true,"x":5,"y":5,"radius":3})";

struct ConversationTest : testing::Test {
  ConversationTest() { EXPECT_TRUE(room::create_map(atlas, "m", {})); }
  room::ManualContext context;
  room::Atlas atlas{{.make_strand = [this] { return context.make_strand(); }}};
  Speaker talk{atlas, context};
};

TEST_F(ConversationTest, StartsWithHello) {
  EXPECT_FALSE(talk.conversation->greeted());
  const auto welcome = talk.one<protocol::Welcome>(kHello);
  EXPECT_EQ(welcome.id, 1);
  EXPECT_EQ(welcome.key.size(), 32u);
  EXPECT_EQ(welcome.session.size(), 16u);
  EXPECT_TRUE(talk.conversation->greeted());
}

TEST_F(ConversationTest, NothingElseIsHeardBefore) {
  talk.refused(kJoin, Code::bad_state, 2);
  talk.refused(R"({"type":"ping"})", Code::bad_state, {});
  EXPECT_FALSE(talk.conversation->ending());
  talk.one<protocol::Welcome>(kHello);
  talk.refused(kHello, Code::bad_state, 1);
}

TEST_F(ConversationTest, AKeyIsKept) {
  const std::string key = "00112233445566778899aabbccddeeff";
  const auto welcome = talk.one<protocol::Welcome>(
      R"({"type":"hello","protocol":[1,9],"name":"ann","key":")" + key + "\"}");
  EXPECT_EQ(welcome.key, key);
}

TEST_F(ConversationTest, WithoutACommonVersionItEnds) {
  const auto bye = talk.one<protocol::Bye>(R"({"type":"hello","protocol":[2,3],"name":"ann"})");
  EXPECT_EQ(bye.failure.code, Code::bad_version);
  EXPECT_TRUE(talk.conversation->ended());
  EXPECT_TRUE(talk.say(kHello).empty());
}

TEST_F(ConversationTest, AHelloWithAnIdIsRefusedUnderIt) {
  const auto messages = talk.say(R"({"type":"hello","protocol":[2,3],"name":"ann","id":7})");
  ASSERT_EQ(messages.size(), 2u);
  const auto& rejected = std::get<protocol::Rejected>(messages[0]);
  EXPECT_EQ(rejected.id, 7);
  EXPECT_EQ(rejected.failure.code, Code::bad_version);
  EXPECT_TRUE(std::holds_alternative<protocol::Bye>(messages[1]));
}

TEST_F(ConversationTest, AServerThatEndsSaysWhenToComeBack) {
  talk.one<protocol::Welcome>(kHello);
  talk.conversation->say_bye({Code::shutting_down, "the server ends", {}});
  const auto messages = talk.hear();
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(std::get<protocol::Bye>(messages[0]).retry_after_ms, 1000u);
}

TEST_F(ConversationTest, JoinTellsOfTheMap) {
  talk.one<protocol::Welcome>(kHello);
  const auto joined = talk.one<protocol::Joined>(kJoin);
  EXPECT_EQ(joined.id, 2);
  EXPECT_EQ(joined.map, "m");
  EXPECT_EQ(joined.epoch, protocol::hex(room::find_map(atlas, "m")->epoch()));
  ASSERT_EQ(joined.users.size(), 1u);
  EXPECT_EQ(joined.users[0].name, "ann");
  EXPECT_EQ(joined.users[0].color.size(), 7u);
}

TEST_F(ConversationTest, JoinIsRefusedWhereItCannotBe) {
  talk.one<protocol::Welcome>(kHello);
  talk.refused(R"({"type":"join","map":"nowhere","id":2})", Code::unknown_map, 2);
  talk.refused(R"({"type":"join","map":"m","seq":3,"id":3})", Code::not_supported, 3);
  talk.one<protocol::Joined>(kJoin);
  talk.refused(R"({"type":"join","map":"m","id":9})", Code::bad_state, 9);
}

TEST_F(ConversationTest, OutsideAMapThereIsNothingToSeeOrDo) {
  talk.one<protocol::Welcome>(kHello);
  talk.refused(kEdit, Code::bad_state, 4);
  talk.refused(R"({"type":"layer","id":4})", Code::bad_state, 4);
  talk.refused(R"({"type":"view","n":1,"all":true,"id":5})", Code::bad_state, 5);
  talk.refused(R"({"type":"leave","id":6})", Code::bad_state, 6);
  talk.refused(R"({"type":"cursor","x":1,"y":2})", Code::bad_state, {});
  talk.refused(R"({"type":"events","from_seq":1,"id":7})", Code::bad_state, 7);
}

TEST_F(ConversationTest, EditsAreAppliedOrRejected) {
  talk.one<protocol::Welcome>(kHello);
  talk.one<protocol::Joined>(kJoin);
  EXPECT_EQ(talk.one<protocol::Applied>(kEdit), (protocol::Applied{4, 1}));
  const auto rejected = talk.one<protocol::Rejected>(
      R"({"type":"edit","id":5,"stencil":"circle","fill":true,"x":5,"y":5,"radius":600})");
  EXPECT_EQ(rejected.id, 5);
  EXPECT_EQ(rejected.failure.field, "radius");
  EXPECT_EQ(room::find_map(atlas, "m")->info().seq, 1u);
}

TEST_F(ConversationTest, AChangeOfLayersIsAppliedOrRejectedAndToldToAll) {
  talk.one<protocol::Welcome>(kHello);
  talk.one<protocol::Joined>(kJoin);
  Speaker other(atlas, context);
  other.one<protocol::Welcome>(kHello);
  other.one<protocol::Joined>(kJoin);
  talk.hear();
  const auto heard = talk.say(R"({"type":"layer","id":5,"name":"roof"})");
  ASSERT_EQ(heard.size(), 2u);
  const auto& changed = std::get<protocol::SettingsChanged>(heard[1]);
  EXPECT_EQ(changed.seq, 1u);
  ASSERT_EQ(changed.settings.layers.size(), 2u);
  EXPECT_EQ(changed.settings.layers[1].name, "roof");
  EXPECT_EQ(std::get<protocol::Applied>(heard[0]), (protocol::Applied{5, 1}));
  const auto told = other.hear();
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(std::get<protocol::SettingsChanged>(told[0]), changed);
  talk.refused(R"({"type":"layer","id":6,"layer":2,"name":"x"})", Code::out_of_range, 6);
  talk.refused(R"({"type":"layer","id":6,"layer":1})", Code::bad_field, 6);
  talk.refused(R"({"type":"layer","name":"x"})", Code::bad_field, {});
}

TEST_F(ConversationTest, WhoDoesNotReadIsToldTheLastSettingsOnly) {
  talk.one<protocol::Welcome>(kHello);
  talk.one<protocol::Joined>(kJoin);
  Speaker other(atlas, context);
  other.one<protocol::Welcome>(kHello);
  other.one<protocol::Joined>(kJoin);
  for (int i = 0; i < 10; ++i)
    talk.say(R"({"type":"layer","name":"roof","id":)" + std::to_string(i + 5) + "}");
  std::size_t told = 0;
  for (const auto& message : other.hear())
    if (const auto* changed = std::get_if<protocol::SettingsChanged>(&message)) {
      ++told;
      EXPECT_EQ(changed->seq, 10u);
      EXPECT_EQ(changed->settings.layers.size(), 11u);
    }
  EXPECT_EQ(told, 1u);
}

TEST_F(ConversationTest, SettingsOfAMapThatWasLeftAreNotToldAfterwards) {
  ASSERT_TRUE(room::create_map(atlas, "n", {}));
  talk.one<protocol::Welcome>(kHello);
  talk.one<protocol::Joined>(kJoin);
  talk.conversation->receive(R"({"type":"layer","id":5,"name":"roof"})");
  talk.conversation->receive(R"({"type":"leave","id":6})");
  context.run();  // nothing is taken meanwhile
  talk.conversation->receive(R"({"type":"join","map":"n","id":7})");
  bool joined = false;
  for (const auto& message : talk.hear()) {
    joined = joined || std::holds_alternative<protocol::Joined>(message);
    EXPECT_FALSE(std::holds_alternative<protocol::SettingsChanged>(message));
  }
  EXPECT_TRUE(joined);
}

TEST_F(ConversationTest, AnEditKeepsItsAuthorsKeyOutOfTheLog) {
  const std::string key = "00112233445566778899aabbccddeeff";
  talk.one<protocol::Welcome>(R"({"type":"hello","protocol":[1,1],"name":"ann","key":")" + key +
                              "\"}");
  talk.one<protocol::Joined>(kJoin);
  talk.one<protocol::Applied>(kEdit);
  Speaker other(atlas, context);
  other.one<protocol::Welcome>(kHello);
  other.one<protocol::Joined>(kJoin);
  other.one<protocol::Applied>(kEdit);
  const auto heard = other.say(R"({"type":"events","from_seq":1})");
  std::vector<std::string> authors;
  for (const auto& message : heard)
    if (const auto* event = std::get_if<protocol::Event>(&message))
      authors.push_back(event->author);
  ASSERT_EQ(authors.size(), 2u);
  EXPECT_NE(authors[0], authors[1]);
  EXPECT_EQ(key.find(authors[0]), std::string::npos);
}

TEST_F(ConversationTest, AViewIsDoneAndThenCaughtUp) {
  talk.one<protocol::Welcome>(kHello);
  talk.one<protocol::Joined>(kJoin);
  talk.one<protocol::Applied>(kEdit);
  const auto heard = talk.say(R"({"type":"view","n":7,"all":true,"id":8})");
  ASSERT_EQ(heard.size(), 2u);
  EXPECT_EQ(std::get<protocol::Done>(heard[0]).id, 8);
  EXPECT_EQ(std::get<protocol::CaughtUp>(heard[1]), (protocol::CaughtUp{7, 1}));
  EXPECT_EQ(talk.binary, 1);
  // A parcel was taken, so the next one comes.
  talk.say(R"({"type":"edit","id":9,"stencil":"square","fill":true,"x":90,"y":5,"radius":3})");
  EXPECT_EQ(talk.binary, 4);
}

TEST_F(ConversationTest, AViewThatIsTooLargeIsRefused) {
  talk.one<protocol::Welcome>(kHello);
  talk.one<protocol::Joined>(kJoin);
  const auto rejected =
      talk.one<protocol::Rejected>(R"({"type":"view","n":7,"rect":[0,0,1e6,1e6],"id":8})");
  EXPECT_EQ(rejected.id, 8);
  EXPECT_EQ(rejected.failure.field, "rect");
}

TEST_F(ConversationTest, LeavingAndJoiningAgain) {
  talk.one<protocol::Welcome>(kHello);
  talk.one<protocol::Joined>(kJoin);
  EXPECT_EQ(talk.one<protocol::Done>(R"({"type":"leave","id":3})").id, 3);
  EXPECT_EQ(room::find_map(atlas, "m")->info().users, 0u);
  talk.refused(kEdit, Code::bad_state, 4);
  talk.one<protocol::Joined>(R"({"type":"join","map":"m","id":5})");
  EXPECT_EQ(room::find_map(atlas, "m")->info().users, 1u);
}

TEST_F(ConversationTest, ALeaveIsDoneAfterTheEditsBeforeIt) {
  talk.one<protocol::Welcome>(kHello);
  // Lost replies would add up until nothing is read any more.
  for (int round = 0; round < 2 * kMaxUnanswered; ++round) {
    talk.one<protocol::Joined>(kJoin);
    ASSERT_TRUE(talk.conversation->may_read());
    const int id = 10 + round;
    talk.conversation->receive(
        R"({"type":"edit","stencil":"circle","fill":true,"x":5,"y":5,"radius":3,"id":)" +
        std::to_string(id) + "}");
    talk.conversation->receive(R"({"type":"leave","id":5})");
    const auto heard = talk.hear();
    ASSERT_EQ(heard.size(), 2u);
    EXPECT_EQ(std::get<protocol::Applied>(heard[0]).id, id);
    EXPECT_EQ(std::get<protocol::Done>(heard[1]).id, 5);
    ASSERT_TRUE(talk.conversation->may_read());
  }
  EXPECT_EQ(room::find_map(atlas, "m")->info().users, 0u);
  EXPECT_EQ(room::find_map(atlas, "m")->info().seq, 128u);
}

TEST_F(ConversationTest, AbandonedDuringALeaveItLeavesTheRoom) {
  talk.one<protocol::Welcome>(kHello);
  talk.one<protocol::Joined>(kJoin);
  talk.conversation->receive(kEdit);
  talk.conversation->receive(R"({"type":"leave","id":5})");
  talk.conversation->abandon();
  context.run();
  EXPECT_EQ(room::find_map(atlas, "m")->info().users, 0u);
  EXPECT_EQ(room::find_map(atlas, "m")->info().seq, 1u);
}

TEST_F(ConversationTest, PingIsDone) {
  talk.one<protocol::Welcome>(kHello);
  EXPECT_EQ(talk.one<protocol::Done>(R"({"type":"ping","id":77})").id, 77);
  EXPECT_TRUE(talk.say(R"({"type":"ping"})").empty());
}

TEST_F(ConversationTest, WhatIsNotOfferedYetIsSaidSo) {
  talk.one<protocol::Welcome>(kHello);
  talk.refused(R"({"type":"undo","id":3})", Code::not_supported, 3);
  talk.refused(R"({"type":"redo","id":4})", Code::not_supported, 4);
}

TEST_F(ConversationTest, ACursorIsDoneWhenItAsksForIt) {
  talk.one<protocol::Welcome>(kHello);
  talk.one<protocol::Joined>(kJoin);
  EXPECT_EQ(talk.one<protocol::Done>(R"({"type":"cursor","x":1,"y":2,"id":5})").id, 5);
  EXPECT_TRUE(talk.say(R"({"type":"cursor","x":1,"y":2})").empty());
  talk.refused(R"({"type":"cursor","x":1e300,"y":2,"id":6})", Code::out_of_range, 6);
  talk.refused(R"({"type":"cursor","x":1e300,"y":2})", Code::out_of_range, {});
}

TEST_F(ConversationTest, OfCursorsInARowTheLatestGoesToTheRoom) {
  talk.one<protocol::Welcome>(kHello);
  talk.one<protocol::Joined>(kJoin);
  for (int i = 0; i < 1000; ++i) {
    ASSERT_TRUE(talk.conversation->may_read()) << i;
    // Only the first and the last one are where they may not be.
    const bool far = i == 0 || i == 999;
    talk.conversation->receive(R"({"type":"cursor","x":)" + std::string(far ? "1e300" : "1") +
                               R"(,"y":2})");
  }
  EXPECT_LT(context.run(), 20);
  EXPECT_EQ(talk.hear().size(), 2u);
}

TEST_F(ConversationTest, EveryCursorWithAnIdIsAnsweredInOrder) {
  talk.one<protocol::Welcome>(kHello);
  talk.one<protocol::Joined>(kJoin);
  int sent = 0;
  while (talk.conversation->may_read())
    talk.conversation->receive(R"({"type":"cursor","x":1,"y":2,"id":)" + std::to_string(++sent) +
                               "}");
  EXPECT_EQ(sent, kMaxUnanswered);
  const auto heard = talk.hear();
  ASSERT_EQ(heard.size(), static_cast<std::size_t>(sent));
  for (int i = 0; i < sent; ++i)
    EXPECT_EQ(std::get<protocol::Done>(heard[static_cast<std::size_t>(i)]).id, i + 1);
}

TEST_F(ConversationTest, EventsComeFromThePastAndLive) {
  talk.one<protocol::Welcome>(kHello);
  talk.one<protocol::Joined>(kJoin);
  talk.one<protocol::Applied>(kEdit);
  const auto past = talk.say(R"({"type":"events","from_seq":1,"id":6})");
  ASSERT_EQ(past.size(), 2u);
  EXPECT_EQ(std::get<protocol::Done>(past[0]).id, 6);
  EXPECT_EQ(std::get<protocol::Event>(past[1]).seq, 1u);
  // Each is told after the one before it was written, so a lost word would end them.
  for (int id = 7; id < 12; ++id) {
    const auto live =
        talk.say(R"({"type":"edit","stencil":"square","fill":true,"x":9,"y":5,"radius":3,"id":)" +
                 std::to_string(id) + "}");
    ASSERT_EQ(live.size(), 2u) << id;
    EXPECT_EQ(std::get<protocol::Applied>(live[0]).id, id);
    EXPECT_EQ(std::get<protocol::Event>(live[1]).seq, static_cast<std::uint64_t>(id) - 5);
  }
  talk.refused(R"({"type":"events","from_seq":99,"id":20})", Code::out_of_range, 20);
}

TEST_F(ConversationTest, TalkOfAMapThatWasLeftIsThroughBeforeTheNextOneIsJoined) {
  talk.one<protocol::Welcome>(kHello);
  talk.one<protocol::Joined>(kJoin);
  talk.one<protocol::Applied>(kEdit);
  talk.conversation->receive(R"({"type":"events","from_seq":1})");
  context.run();  // the event is here, and not written
  talk.conversation->receive(R"({"type":"leave","id":3})");
  context.run();
  EXPECT_FALSE(talk.conversation->may_read());
  EXPECT_EQ(talk.take().size(), 1u);  // done
  EXPECT_EQ(talk.take().size(), 1u);  // event
  EXPECT_FALSE(talk.conversation->may_read());
  talk.conversation->written();
  EXPECT_TRUE(talk.conversation->may_read());
}

TEST_F(ConversationTest, RefusalsAndMessagesAreCounted) {
  const room::Meters& meters = atlas.meters();
  const auto rejected = [&](Code code) {
    return meters.rejected[static_cast<std::size_t>(code)].load();
  };
  talk.refused(kJoin, Code::bad_state, 2);
  talk.refused(kEdit, Code::bad_state, 4);
  talk.one<protocol::Welcome>(kHello);
  talk.one<protocol::Joined>(kJoin);
  talk.one<protocol::Applied>(kEdit);
  talk.refused(R"({"type":"undo","id":9})", Code::not_supported, 9);
  talk.refused("nonsense", Code::bad_json, {});
  EXPECT_EQ(rejected(Code::bad_state), 2u);
  EXPECT_EQ(rejected(Code::not_supported), 1u);
  EXPECT_EQ(rejected(Code::bad_json), 1u);
  EXPECT_EQ(rejected(Code::out_of_range), 0u);
  EXPECT_EQ(meters.controls, 7u);
  EXPECT_EQ(meters.frames, 0u);
  talk.say(R"({"type":"view","n":1,"all":true})");
  EXPECT_EQ(meters.controls, 8u);  // caught_up
  EXPECT_EQ(meters.frames, 1u);
  EXPECT_GT(meters.frame_bytes, 50u);
}

TEST_F(ConversationTest, WhatCannotBeReadIsRejectedWithItsId) {
  talk.one<protocol::Welcome>(kHello);
  talk.refused("nonsense", Code::bad_json, {});
  talk.refused("", Code::bad_json, {});
  talk.refused(R"({"type":"edit","id":12,"stencil":"star"})", Code::bad_field, 12);
  talk.refused(R"({"type":"dance","id":13})", Code::bad_message, 13);
}

TEST_F(ConversationTest, BinaryIsRefused) {
  talk.one<protocol::Welcome>(kHello);
  talk.conversation->refuse_binary();
  const auto heard = talk.hear();
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_EQ(std::get<protocol::Rejected>(heard[0]).failure.code, Code::bad_message);
}

TEST_F(ConversationTest, IsNotReadWhileAJoinIsUnderWay) {
  talk.one<protocol::Welcome>(kHello);
  talk.conversation->receive(kJoin);
  EXPECT_FALSE(talk.conversation->may_read());
  talk.hear();
  EXPECT_TRUE(talk.conversation->may_read());
}

TEST_F(ConversationTest, IsNotReadWhileTooMuchIsUnanswered) {
  talk.one<protocol::Welcome>(kHello);
  talk.one<protocol::Joined>(kJoin);
  for (int i = 0; i < kMaxUnanswered; ++i) {
    EXPECT_TRUE(talk.conversation->may_read()) << i;
    talk.conversation->receive(kEdit);
  }
  EXPECT_FALSE(talk.conversation->may_read());
  const int wakes = talk.wakes;
  EXPECT_EQ(talk.hear().size(), 64u);
  EXPECT_TRUE(talk.conversation->may_read());
  EXPECT_GT(talk.wakes, wakes);
}

TEST_F(ConversationTest, RefusalsAreAnswersToo) {
  talk.one<protocol::Welcome>(kHello);
  talk.one<protocol::Joined>(kJoin);
  for (int i = 0; i < 2 * kMaxUnanswered; ++i) {
    ASSERT_TRUE(talk.conversation->may_read()) << i;
    talk.say(R"({"type":"edit","id":5,"stencil":"circle","fill":true,"x":0,"y":0,"radius":600})");
    talk.say(R"({"type":"view","n":1,"all":true})");
  }
}

TEST_F(ConversationTest, WhatAMapHadSentIsThroughBeforeTheNextOneIsJoined) {
  talk.one<protocol::Welcome>(kHello);
  talk.one<protocol::Joined>(kJoin);
  talk.one<protocol::Applied>(kEdit);
  talk.conversation->receive(R"({"type":"view","n":1,"all":true})");
  context.run();  // the parcel is here, and not written
  talk.conversation->receive(R"({"type":"leave","id":3})");
  context.run();
  EXPECT_FALSE(talk.conversation->may_read());
  EXPECT_EQ(talk.hear().size(), 2u);  // done, caught_up
  EXPECT_EQ(talk.binary, 1);
  EXPECT_TRUE(talk.conversation->may_read());
}

TEST_F(ConversationTest, IsNotReadWhileItDoesNotRead) {
  talk.one<protocol::Welcome>(kHello);
  int pings = 0;
  for (; talk.conversation->may_read(); ++pings)
    talk.conversation->receive(R"({"type":"ping","id":1})");
  EXPECT_GT(pings, 1000);
  EXPECT_LT(pings, 10'000);
  talk.hear();
  EXPECT_TRUE(talk.conversation->may_read());
}

TEST_F(ConversationTest, SaysByeWhenTheMapIsDeleted) {
  talk.one<protocol::Welcome>(kHello);
  talk.one<protocol::Joined>(kJoin);
  room::erase_map(atlas, "m");
  context.run();
  const auto heard = talk.hear();
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_EQ(std::get<protocol::Bye>(heard[0]).failure.code, Code::unknown_map);
  EXPECT_TRUE(talk.conversation->ended());
}

TEST_F(ConversationTest, AMapThatIsDeletedDuringTheJoinIsUnknown) {
  talk.one<protocol::Welcome>(kHello);
  const auto room = room::find_map(atlas, "m");
  room->close({{Code::unknown_map, "gone", "map"}, {}});
  talk.refused(kJoin, Code::unknown_map, 2);
}

TEST_F(ConversationTest, AbandonedItLeavesTheRoomAndWakesNobody) {
  talk.one<protocol::Welcome>(kHello);
  talk.one<protocol::Joined>(kJoin);
  talk.conversation->receive(kEdit);
  const int wakes = talk.wakes;
  talk.conversation->abandon();
  context.run();
  EXPECT_EQ(room::find_map(atlas, "m")->info().users, 0u);
  EXPECT_EQ(talk.wakes, wakes);
}

TEST_F(ConversationTest, AbandonedDuringTheJoinItLeavesTheRoomToo) {
  talk.one<protocol::Welcome>(kHello);
  talk.conversation->receive(kJoin);
  talk.conversation->abandon();
  context.run();
  EXPECT_EQ(room::find_map(atlas, "m")->info().users, 0u);
}

/// Over maps that lie on a shelf, where opening waits until it is told to go on.
struct KeptConversationTest : testing::Test {
  KeptConversationTest() {
    shelf->put("m", {.settings = {}, .epoch = 0xA, .created_ms = 1});
    EXPECT_TRUE(atlas.take_stock());
    talk.one<protocol::Welcome>(kHello);
  }
  void open_what_waits() {
    for (context.run(); !aside.empty(); context.run())
      for (const auto& task : std::exchange(aside, {})) task();
  }
  /// What is said in answer, once all is opened that has to be.
  template <class T>
  T one_opened(const std::string& text) {
    talk.conversation->receive(text);
    open_what_waits();
    const auto heard = talk.hear();
    EXPECT_EQ(heard.size(), 1u) << text;
    return std::get<T>(heard.at(0));
  }

  room::ManualContext context;
  std::vector<room::Strand::Task> aside;
  std::shared_ptr<room::KeptShelf> shelf = std::make_shared<room::KeptShelf>();
  room::Atlas atlas{
      {.make_strand = [this] { return context.make_strand(); },
       .shelf = shelf,
       .aside = [this](room::Strand::Task task) { aside.push_back(std::move(task)); }}};
  Speaker talk{atlas, context};
};

TEST_F(KeptConversationTest, AJoinWaitsUntilTheMapIsOpen) {
  EXPECT_TRUE(talk.say(kJoin).empty());
  EXPECT_FALSE(talk.conversation->may_read());
  open_what_waits();
  const auto heard = talk.hear();
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_EQ(std::get<protocol::Joined>(heard[0]).epoch, "000000000000000a");
  EXPECT_TRUE(talk.conversation->may_read());
}

TEST_F(KeptConversationTest, AbandonedWhileTheMapIsOpenedItLeavesIt) {
  talk.conversation->receive(kJoin);
  talk.conversation->abandon();
  open_what_waits();
  ASSERT_EQ(atlas.rooms().size(), 1u);
  EXPECT_EQ(atlas.rooms()[0]->info().users, 0u);
}

TEST_F(KeptConversationTest, AMapThatCannotBeOpenedIsRefusedAndTheSessionGoesOn) {
  shelf->put("bad", {}).broken = {Code::damaged, "bad.earthwork: events, seq 3", {}};
  room::Atlas fresh{{.make_strand = [this] { return context.make_strand(); }, .shelf = shelf}};
  ASSERT_TRUE(fresh.take_stock());
  Speaker speaker(fresh, context);
  speaker.one<protocol::Welcome>(kHello);
  speaker.refused(R"({"type":"join","map":"bad","id":2})", Code::damaged, 2);
  EXPECT_TRUE(speaker.conversation->may_read());
  speaker.one<protocol::Joined>(kJoin);
}

TEST_F(KeptConversationTest, AMapThatIsPutAwayMeanwhileIsOpenedAgain) {
  one_opened<protocol::Joined>(kJoin);
  one_opened<protocol::Done>(R"({"type":"leave","id":3})");
  const auto room = atlas.rooms().at(0);
  talk.conversation->receive(kJoin);
  // The room is found, and closes before the join gets there.
  ASSERT_TRUE(room->retire([] {}));
  open_what_waits();
  const auto heard = talk.hear();
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_EQ(std::get<protocol::Joined>(heard[0]).epoch, "000000000000000a");
  EXPECT_NE(atlas.rooms().at(0), room);
}

TEST_F(KeptConversationTest, AnEditThatCannotBeStoredIsRejectedAndTheNextOneIsTriedAgain) {
  one_opened<protocol::Joined>(kJoin);
  shelf->maps.at("m").unwritable = {Code::disk_full, "m.earthwork: no room", {}};
  talk.refused(kEdit, Code::disk_full, 4);
  shelf->maps.at("m").unwritable.reset();
  context.advance(std::chrono::seconds(2));
  EXPECT_EQ(talk.one<protocol::Applied>(kEdit), (protocol::Applied{4, 1}));
}

TEST_F(KeptConversationTest, AMapThatMustBeOpenedAnewSaysWhenToComeBack) {
  one_opened<protocol::Joined>(kJoin);
  shelf->maps.at("m").unwritable = {Code::bad_state, "somebody else has written", {}};
  const auto bye = one_opened<protocol::Bye>(kEdit);
  EXPECT_EQ(bye.failure.code, Code::bad_state);
  EXPECT_TRUE(bye.retry_after_ms);
  shelf->maps.at("m").unwritable.reset();
  Speaker again(atlas, context);
  again.one<protocol::Welcome>(kHello);
  again.conversation->receive(kJoin);
  open_what_waits();
  EXPECT_EQ(std::get<protocol::Joined>(again.hear().at(0)).seq, 0u);
}

}  // namespace
}  // namespace earthwork::net
