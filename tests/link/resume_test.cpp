// What a client says again after its connection was lost, when it tries, and when it stops.
#include "client/link/resume.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <deque>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

namespace earthwork::link {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using protocol::Applied;
using protocol::Code;
using protocol::MessageId;

const Resume::Time kStart{};
const std::string kEpoch = "00000000000000aa";
const Closing kBroken{.cause = CloseCause::lost,
                      .failure = {.code = Code::internal, .detail = "reset", .field = {}}};
const Closing kNobody{.cause = CloseCause::unreachable,
                      .failure = {.code = Code::internal, .detail = "refused", .field = {}}};

protocol::Welcome welcome() {
  protocol::Welcome out;
  out.key = "0123456789abcdef0123456789abcdef";
  return out;
}

protocol::Joined joined(const std::string& epoch = kEpoch) {
  protocol::Joined out;
  out.map = "demo";
  out.epoch = epoch;
  return out;
}

Closing closing(CloseCause cause, Code code) {
  return {.cause = cause, .failure = {.code = code, .detail = "because", .field = {}}};
}

protocol::Edit circle() {
  protocol::Edit edit;
  edit.path = {{1, 2}};
  return edit;
}

Resume made(std::optional<std::chrono::milliseconds> patience = 60s,
            FirstTry first_try = FirstTry::must_reach) {
  return Resume({.hello = {}, .patience = patience, .first_try = first_try}, 7, kStart);
}

/// A connection that has joined at `now`.
Resume::Entrance enter(Resume& resume, Resume::Time now = kStart,
                       const std::string& epoch = kEpoch) {
  resume.take_welcome(welcome());
  return resume.take_joined(joined(epoch), now);
}

std::vector<MessageId> ids(const std::vector<std::string>& messages) {
  std::vector<MessageId> out;
  for (const std::string& message : messages) out.push_back(json::parse(message)["id"]);
  return out;
}

TEST(Resume, SaysTheKeyOfItsFirstWelcomeFromThenOn) {
  Resume resume = made();
  EXPECT_EQ(resume.hello().key, std::nullopt);
  resume.take_welcome(welcome());
  EXPECT_EQ(resume.hello().key, "0123456789abcdef0123456789abcdef");
}

TEST(Resume, SaysAgainInOrderWhatWasNotAnswered) {
  Resume resume = made();
  for (int i = 0; i < 2; ++i) ASSERT_TRUE(resume.add(circle()));
  EXPECT_EQ(enter(resume).joining, Joining::first);
  EXPECT_EQ(ids(resume.opening({})), (std::vector<MessageId>{1, 2}));
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(resume.add(circle()));
  const auto answer = resume.take(Applied{.id = 2, .seq = 9});
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->id, 2);
  EXPECT_EQ(answer->fate, Fate::applied);
  EXPECT_EQ(answer->seq, 9u);

  ASSERT_TRUE(resume.take_end(kBroken, kStart));
  EXPECT_EQ(enter(resume).joining, Joining::again);
  EXPECT_EQ(ids(resume.opening({})), (std::vector<MessageId>{1, 3, 4, 5}));
}

TEST(Resume, HandsEachAnswerBackOnce) {
  Resume resume = made();
  for (int i = 0; i < 2; ++i) ASSERT_TRUE(resume.add(circle()));
  enter(resume);
  EXPECT_TRUE(resume.take(Applied{.id = 1, .seq = 1}));
  EXPECT_FALSE(resume.take(Applied{.id = 1, .seq = 1}));
  EXPECT_FALSE(resume.take(Applied{.id = 3, .seq = 1}));
  const protocol::Failure why{.code = Code::out_of_range, .detail = "radius", .field = "radius"};
  EXPECT_FALSE(resume.take(protocol::Rejected{.id = {}, .failure = why}));
  const auto rejected = resume.take(protocol::Rejected{.id = 2, .failure = why});
  ASSERT_TRUE(rejected);
  EXPECT_EQ(rejected->fate, Fate::rejected);
  EXPECT_EQ(rejected->why, why);
  EXPECT_TRUE(resume.give_up(why).empty());
}

TEST(Resume, LosesTheEditsOfAMapThatIsGone) {
  Resume resume = made();
  enter(resume);
  for (int i = 0; i < 2; ++i) ASSERT_TRUE(resume.add(circle()));
  ASSERT_TRUE(resume.take_end(kBroken, kStart));
  const auto entrance = enter(resume, kStart, "00000000000000bb");
  EXPECT_EQ(entrance.joining, Joining::another_map);
  ASSERT_EQ(entrance.lost.size(), 2u);
  EXPECT_EQ(entrance.lost[1].id, 2);
  EXPECT_EQ(entrance.lost[1].fate, Fate::lost);
  EXPECT_EQ(entrance.lost[1].why.code, Code::unknown_map);
  EXPECT_TRUE(resume.opening({}).empty());
  EXPECT_EQ(resume.add(circle())->id, 3);
}

TEST(Resume, AsksForItsLastViewWithWhatTheViewerHas) {
  Resume resume = made();
  EXPECT_FALSE(resume.looks());
  const std::string live = resume.look({.n = 1, .rect = {}, .have = {}, .id = {}});
  EXPECT_EQ(live, R"({"type":"view","n":1,"all":true})");
  static_cast<void>(resume.look({.n = 2, .rect = {{0, 0, 8, 8}}, .have = {}, .id = {}}));
  ASSERT_TRUE(resume.add(circle()));
  enter(resume);
  EXPECT_TRUE(resume.looks());
  const auto said = resume.opening(protocol::Have{.epoch = kEpoch, .seq = 5, .rect = {0, 0, 4, 4}});
  ASSERT_EQ(said.size(), 2u);
  EXPECT_EQ(json::parse(said[0])["n"], 2);
  EXPECT_EQ(json::parse(said[0])["have"]["seq"], 5);
  EXPECT_EQ(json::parse(said[1])["type"], "edit");
  EXPECT_EQ(json::parse(resume.opening({})[0]).contains("have"), false);
}

TEST(Resume, WaitsLongerEachTimeAndAnewAfterAUsefulConnection) {
  Resume resume = made(std::nullopt);
  enter(resume);
  for (const auto d : {250ms, 500ms, 1000ms}) {
    const auto delay = resume.take_end(kNobody, kStart);
    ASSERT_TRUE(delay);
    EXPECT_GE(*delay, d == 250ms ? 125ms : d / 2);
    EXPECT_LE(*delay, d);
  }
  enter(resume);
  EXPECT_LE(resume.take_end(kBroken, kStart), 250ms) << "nothing was asked for, so it was enough";
}

TEST(Resume, CountsAConnectionThatBroughtNothingAsNone) {
  Resume resume = made(2s);
  ASSERT_TRUE(resume.add(circle()));
  enter(resume);
  ASSERT_TRUE(resume.take_end(kBroken, kStart));
  enter(resume, kStart + 1900ms);
  EXPECT_TRUE(resume.take_end(kBroken, kStart + 1999ms));
  enter(resume, kStart + 2s);
  EXPECT_FALSE(resume.take_end(kBroken, kStart + 2s)) << "joined three times, for nothing";
}

TEST(Resume, CountsAnAnswerAFrameOrFiveSecondsAsUse) {
  for (const char* what : {"answer", "frame", "caught up", "time"}) {
    Resume resume = made(2s);
    ASSERT_TRUE(resume.add(circle()));
    static_cast<void>(resume.look({.n = 1, .rect = {}, .have = {}, .id = {}}));
    enter(resume, kStart + 1s);
    auto end = kStart + 4s;
    if (what == std::string("answer")) EXPECT_TRUE(resume.take(Applied{.id = 1, .seq = 1}));
    if (what == std::string("frame")) resume.take_frame();
    if (what == std::string("caught up")) EXPECT_FALSE(resume.take(protocol::CaughtUp{1, 1}));
    if (what == std::string("time")) end = kStart + 6s;
    EXPECT_TRUE(resume.take_end(kBroken, end)) << what;
    EXPECT_TRUE(resume.take_end(kNobody, end + 1999ms)) << what;
    EXPECT_FALSE(resume.take_end(kNobody, end + 2s)) << what;
  }
}

TEST(Resume, TriesALastTimeWhenItsPatienceEnds) {
  Resume resume = made(10s);
  enter(resume);
  Resume::Time now = kStart;
  std::chrono::milliseconds waited{};
  for (auto delay = resume.take_end(kBroken, now); delay; delay = resume.take_end(kNobody, now)) {
    waited += *delay;
    now += *delay;
  }
  EXPECT_EQ(waited, 10s);
}

TEST(Resume, HonoursWhatAByeAsksFor) {
  const auto bye = [](std::uint32_t ms) {
    return protocol::Bye{.failure = {.code = Code::shutting_down, .detail = {}, .field = {}},
                         .retry_after_ms = ms};
  };
  const Closing ends = closing(CloseCause::lost, Code::shutting_down);
  Resume resume = made(60s);
  enter(resume);
  EXPECT_FALSE(resume.take(bye(5000)));
  const auto delay = resume.take_end(ends, kStart);
  EXPECT_GE(delay, 5000ms);
  EXPECT_LE(delay, 7500ms);
  EXPECT_LE(resume.take_end(kNobody, kStart), 500ms) << "asked once";
  enter(resume);
  EXPECT_FALSE(resume.take(bye(60'001)));
  EXPECT_FALSE(resume.take_end(ends, kStart)) << "longer than its patience";
}

TEST(Resume, EndsWhereAnotherTryWouldBeToldTheSame) {
  using enum CloseCause;
  const auto again = [](CloseCause cause, Code code) {
    Resume resume = made();
    enter(resume);
    return resume.take_end(closing(cause, code), kStart).has_value();
  };
  for (const CloseCause cause : {lost, refused}) {
    EXPECT_FALSE(again(cause, Code::unknown_map));
    EXPECT_FALSE(again(cause, Code::bad_version));
    EXPECT_TRUE(again(cause, Code::internal));
    EXPECT_TRUE(again(cause, Code::timeout));
    EXPECT_TRUE(again(cause, Code::shutting_down));
  }
  EXPECT_FALSE(again(refused, Code::bad_field));
  EXPECT_TRUE(again(lost, Code::bad_frame));
  EXPECT_TRUE(again(unreachable, Code::internal));
  EXPECT_FALSE(again(asked, Code::internal));
}

TEST(Resume, GivesUpAServerThatKeepsSendingNonsense) {
  Resume resume = made(10s);
  Resume::Time now = kStart;
  int tries = 0;
  for (bool goes_on = true; goes_on; ++tries) {
    ASSERT_LT(tries, 100);
    enter(resume, now);
    const auto delay = resume.take_end(closing(CloseCause::lost, Code::bad_frame), now);
    goes_on = delay.has_value();
    if (delay) now += *delay;
  }
  EXPECT_EQ(now, kStart + 10s);
}

TEST(Resume, NeedsToReachTheServerAtFirstUnlessTold) {
  EXPECT_FALSE(made().take_end(kNobody, kStart));
  EXPECT_TRUE(made(60s, FirstTry::may_fail).take_end(kNobody, kStart));
  EXPECT_TRUE(made().take_end(kBroken, kStart)) << "it was there";
}

/// A server that does what the protocol says of ids, and a wire that loses what is on it.
struct Map {
  std::map<MessageId, std::uint64_t> applied;
  std::set<MessageId> refused;
  std::deque<std::string> to_server;
  std::deque<protocol::ServerMessage> to_client;

  void take_one() {
    if (to_server.empty()) return;
    const MessageId id = json::parse(to_server.front())["id"];
    to_server.pop_front();
    const bool newest = applied.empty() || id > applied.rbegin()->first;
    if (applied.contains(id) || (newest && id % 5 != 0)) {
      applied.emplace(id, applied.size() + 1);
      to_client.push_back(Applied{.id = id, .seq = applied.at(id)});
    } else {
      refused.insert(id);
      to_client.push_back(protocol::Rejected{
          .id = id,
          .failure = {.code = newest ? Code::out_of_range : Code::id_out_of_order,
                      .detail = {},
                      .field = {}}});
    }
  }
  void cut() {
    to_server.clear();
    to_client.clear();
  }
};

RC_GTEST_PROP(Resume, EveryEditIsAnsweredOnceAndAppliedOnceWhateverIsCut, ()) {
  Resume resume = made(std::nullopt);
  Map map;
  std::map<MessageId, Answer> answers;
  const auto hear_one = [&] {
    if (map.to_client.empty()) return;
    if (const auto answer = resume.take(map.to_client.front()))
      RC_ASSERT(answers.emplace(answer->id, *answer).second);
    map.to_client.pop_front();
  };
  const auto reconnect = [&] {
    map.cut();
    RC_ASSERT(resume.take_end(kBroken, kStart).has_value());
    RC_ASSERT(enter(resume).lost.empty());
    for (std::string& message : resume.opening({})) map.to_server.push_back(std::move(message));
  };
  enter(resume);
  const auto steps = *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 10));
  MessageId made = 0;
  for (const int step : steps) {
    if (step <= 2) {
      const auto kept = resume.add(circle());
      RC_ASSERT(kept->id == ++made);
      map.to_server.emplace_back(kept->message);
    } else if (step <= 5) {
      map.take_one();
    } else if (step <= 8) {
      hear_one();
    } else {
      reconnect();
    }
  }
  reconnect();
  while (!map.to_server.empty()) map.take_one();
  while (!map.to_client.empty()) hear_one();

  RC_ASSERT(static_cast<MessageId>(answers.size()) == made);
  RC_ASSERT(resume.unanswered().edits().empty());
  std::uint64_t last_seq = 0;
  for (const auto& [id, answer] : answers) {
    RC_ASSERT((answer.fate == Fate::applied) == map.applied.contains(id));
    RC_ASSERT((answer.fate == Fate::rejected) == (id % 5 == 0));
    if (answer.fate == Fate::rejected) continue;
    RC_ASSERT(answer.seq == map.applied.at(id));
    RC_ASSERT(answer.seq == ++last_seq);
  }
}

}  // namespace
}  // namespace earthwork::link
