// The lasting part in a map: joined again after every loss, with nothing lost and nothing twice.
#include "client/link/membership.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "tests/link/fake_map.hpp"

namespace earthwork::link {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using protocol::Code;
using protocol::MessageId;
using How = Break::How;

protocol::Edit circle() {
  protocol::Edit edit;
  edit.path = {{1, 2}};
  edit.radius = 3;
  return edit;
}

/// A membership with its owner, who writes down what it is told.
struct Member {
  explicit Member(const ServerAddress& server,
                  std::optional<std::chrono::milliseconds> patience = 60s) {
    protocol::Hello hello;
    hello.name = "tester";
    membership.emplace(
        loop,
        MembershipOptions{
            .server = server, .map = "demo", .resume = {.hello = hello, .patience = patience}},
        MembershipHandlers{.joined =
                               [this](const protocol::Joined& joined, Joining how) {
                                 log += "joined:" + std::to_string(static_cast<int>(how)) + " ";
                                 EXPECT_EQ(joined.map, "demo");
                                 if (on_joined) on_joined(how);
                               },
                           .have = [this] { return have; },
                           .answered =
                               [this](const Answer& answer) {
                                 answers.push_back(answer);
                                 if (answer.fate == Fate::lost)
                                   log += "lost:" + std::to_string(answer.id) + " ";
                                 if (on_answered) on_answered(answer);
                               },
                           .message = {},
                           .frame = {},
                           .lost =
                               [this](const Closing& why, std::chrono::milliseconds delay) {
                                 log += "away ";
                                 delays.push_back(delay);
                                 EXPECT_NE(why.failure.detail, "");
                                 if (on_lost) on_lost();
                               },
                           .ended =
                               [this](const Closing& closing) {
                                 log += "ended ";
                                 end = closing;
                               }});
  }
  void edits(int count) {
    for (int i = 0; i < count; ++i) EXPECT_TRUE(membership->edit(circle()));
  }
  void close_after(std::size_t count) {
    on_answered = [this, count](const Answer&) {
      if (answers.size() == count) membership->close();
    };
  }

  EventLoop loop;
  Timer timer{loop};
  std::string log;
  std::vector<Answer> answers;
  std::vector<std::chrono::milliseconds> delays;
  std::optional<protocol::Have> have;
  std::optional<Closing> end;
  std::function<void(Joining)> on_joined;
  std::function<void(const Answer&)> on_answered;
  std::function<void()> on_lost;
  std::optional<Membership> membership;
};

/// Plays the map to a member until that has ended.
void meet(FakeMap& map, const std::function<void(Member&)>& prepare,
          const std::function<void(const Member&)>& check,
          std::optional<std::chrono::milliseconds> patience = 60s) {
  const FakeServer server("earthwork.v1", [&map](Peer& peer) { map.play(peer); });
  Member member(server.address(), patience);
  prepare(member);
  member.loop.run();
  ASSERT_TRUE(member.end);
  check(member);
  member.membership.reset();
}

std::vector<MessageId> edit_ids(const std::vector<std::string>& heard) {
  std::vector<MessageId> out;
  for (const std::string& text : heard)
    if (!text.starts_with("closed") && json::parse(text)["type"] == "edit")
      out.push_back(json::parse(text)["id"]);
  return out;
}

using Ids = std::vector<MessageId>;

TEST(Membership, JoinsAgainWithItsKeyAndSendsAgainWhatWasNotAnswered) {
  FakeMap map;
  map.breaks = {{.after_messages = 1, .how = How::before_the_answer}};
  meet(
      map,
      [](Member& m) {
        m.edits(3);
        m.close_after(3);
      },
      [](const Member& m) {
        EXPECT_EQ(m.log, "joined:0 away joined:1 ended ");
        EXPECT_EQ(m.end->cause, CloseCause::asked);
        ASSERT_EQ(m.answers.size(), 3u);
        for (std::size_t i = 0; i < 3; ++i) {
          EXPECT_EQ(m.answers[i].id, static_cast<MessageId>(i + 1));
          EXPECT_EQ(m.answers[i].fate, Fate::applied);
          EXPECT_EQ(m.answers[i].seq, 4 + i);
        }
        ASSERT_EQ(m.delays.size(), 1u);
        EXPECT_GE(m.delays[0], 125ms);
        EXPECT_LE(m.delays[0], 250ms);
      });
  ASSERT_EQ(map.heard.size(), 2u);
  EXPECT_FALSE(json::parse(map.heard[0][0]).contains("key"));
  EXPECT_EQ(json::parse(map.heard[1][0])["key"], "0123456789abcdef0123456789abcdef");
  EXPECT_EQ(json::parse(map.heard[1][0])["name"], "tester");
  EXPECT_EQ(edit_ids(map.heard[1]), (Ids{2, 3}));
  EXPECT_EQ(map.seq, 6u);
}

TEST(Membership, SendsChangesOfLayersAgainAmongTheEdits) {
  FakeMap map;
  map.breaks = {{.after_messages = 0, .how = How::before_the_answer}};
  meet(
      map,
      [](Member& m) {
        m.edits(1);
        EXPECT_EQ(m.membership->edit(protocol::LayerChange{}), 2);
        m.edits(1);
        m.close_after(3);
      },
      [](const Member& m) {
        ASSERT_EQ(m.answers.size(), 3u);
        for (const Answer& answer : m.answers) EXPECT_EQ(answer.fate, Fate::applied);
      });
  ASSERT_EQ(map.heard.size(), 2u);
  std::vector<std::string> types;
  for (const std::string& text : map.heard[1])
    if (!text.starts_with("closed")) types.push_back(json::parse(text)["type"]);
  EXPECT_EQ(types, (std::vector<std::string>{"hello", "join", "edit", "layer", "edit"}));
}

TEST(Membership, SendsWhatWasMadeMeanwhileAfterWhatIsSentAgain) {
  FakeMap map;
  map.breaks = {{.after_messages = 0, .how = How::before_the_answer}};
  meet(
      map,
      [](Member& m) {
        m.on_joined = [&m](Joining how) { m.edits(how == Joining::first ? 2 : 1); };
        m.on_lost = [&m] { m.edits(1); };
        m.close_after(4);
      },
      [](const Member& m) { EXPECT_EQ(m.log, "joined:0 away joined:1 ended "); });
  EXPECT_EQ(edit_ids(map.heard[1]), (Ids{1, 2, 3, 4}));
}

TEST(Membership, HandsAnAnswerThatComesTwiceBackOnce) {
  FakeMap map;
  map.answers_twice = true;
  meet(
      map,
      [](Member& m) {
        m.edits(3);
        m.close_after(3);
      },
      [](const Member& m) { EXPECT_EQ(m.answers.size(), 3u); });
}

TEST(Membership, HandsBackAsLostWhatWasForAnotherMap) {
  FakeMap map;
  map.breaks = {{.after_messages = 0, .how = How::before_the_answer}};
  map.after = [](FakeMap& m, std::size_t) { m.epoch = "00000000000000bb"; };
  meet(
      map,
      [](Member& m) {
        m.edits(2);
        m.on_joined = [&m](Joining how) {
          if (how == Joining::another_map) m.membership->close();
        };
      },
      [](const Member& m) { EXPECT_EQ(m.log, "joined:0 away lost:1 lost:2 joined:2 ended "); });
  EXPECT_EQ(edit_ids(map.heard[1]), Ids{});
}

TEST(Membership, EndsWhenItsMapIsGone) {
  FakeMap map;
  map.breaks = {{.after_messages = 0, .how = How::before_the_answer}};
  map.after = [](FakeMap& m, std::size_t) { m.gone = true; };
  meet(
      map, [](Member& m) { m.edits(1); },
      [](const Member& m) {
        EXPECT_EQ(m.log, "joined:0 away lost:1 ended ");
        EXPECT_EQ(m.end->cause, CloseCause::refused);
        EXPECT_EQ(m.end->failure.code, Code::unknown_map);
        EXPECT_EQ(m.answers[0].why.detail, "there is no demo");
      });
}

TEST(Membership, AsksForItsViewAgainWithWhatItsOwnerHas) {
  FakeMap map;
  map.breaks = {{.after_messages = 0, .how = How::before_the_answer}};
  meet(
      map,
      [](Member& m) {
        m.membership->look({.n = 4, .rect = {}, .have = {}, .id = {}});
        m.on_lost = [&m] {
          m.have = protocol::Have{.epoch = "00000000000000aa", .seq = 3, .rect = {0, 0, 8, 8}};
        };
        m.on_joined = [&m](Joining how) {
          if (how == Joining::again) m.edits(1);
        };
        m.close_after(1);
      },
      [](const Member&) {});
  EXPECT_EQ(map.heard[0][2], R"({"type":"view","n":4,"all":true})");
  const json again = json::parse(map.heard[1][2]);
  EXPECT_EQ(again["n"], 4);
  EXPECT_EQ(again["have"]["seq"], 3);
}

TEST(Membership, ComesBackNoSoonerThanAByeAsks) {
  FakeMap map;
  map.breaks = {{.after_messages = 0, .how = How::with_bye}};
  map.retry_after_ms = 400;
  meet(
      map,
      [](Member& m) {
        m.edits(1);
        m.close_after(1);
      },
      [](const Member& m) {
        ASSERT_EQ(m.delays.size(), 1u);
        EXPECT_GE(m.delays[0], 400ms);
        EXPECT_LE(m.delays[0], 600ms);
      });
}

TEST(Membership, GivesUpWhenItsPatienceEnds) {
  FakeMap map;
  map.breaks = {{.after_messages = 0, .how = How::before_the_answer}};
  meet(
      map, [](Member& m) { m.edits(2); },
      [](const Member& m) {
        EXPECT_EQ(m.log, "joined:0 lost:1 lost:2 ended ");
        EXPECT_EQ(m.end->cause, CloseCause::lost);
        EXPECT_NE(m.answers[0].why.detail.find("was lost"), std::string::npos);
      },
      0ms);
}

TEST(Membership, EndsAtOnceWhereNobodyIs) {
  Member member(nobody());
  member.loop.run();
  EXPECT_EQ(member.log, "ended ");
  EXPECT_EQ(member.end->cause, CloseCause::unreachable);
}

TEST(Membership, ComesBackFromACutOfItsOwn) {
  FakeMap map;
  meet(
      map,
      [](Member& m) {
        m.on_joined = [&m](Joining how) {
          if (how == Joining::again) return m.edits(1);
          m.membership->cut();
          EXPECT_FALSE(m.membership->joined());
        };
        m.close_after(1);
      },
      [](const Member& m) { EXPECT_EQ(m.log, "joined:0 away joined:1 ended "); });
}

TEST(Membership, EndsInGoodOrderWhereverItIsClosed) {
  for (const bool away : {false, true}) {
    FakeMap map;
    map.breaks = {{.after_messages = 0, .how = How::before_the_answer}};
    meet(
        map,
        [away](Member& m) {
          m.edits(1);
          const auto close = [&m] {
            m.membership->close();
            EXPECT_FALSE(m.membership->edit(circle()));
            EXPECT_FALSE(m.membership->edit(protocol::LayerChange{}));
            EXPECT_FALSE(m.membership->send(protocol::Ping{}));
            m.log += "closed ";
          };
          if (away)
            m.on_lost = close;
          else
            m.on_joined = [close](Joining) { close(); };
        },
        [away](const Member& m) {
          EXPECT_EQ(m.log,
                    away ? "joined:0 away closed lost:1 ended " : "joined:0 closed lost:1 ended ");
          EXPECT_EQ(m.end->cause, CloseCause::asked);
        });
  }
}

TEST(Membership, SendsOtherMessagesOnlyWhileItHasJoined) {
  FakeMap map;
  meet(
      map,
      [](Member& m) {
        const auto early = m.membership->send(protocol::Ping{});
        ASSERT_FALSE(early);
        EXPECT_EQ(early.error().code, Code::bad_state);
        m.edits(1);
        m.on_answered = [&m](const Answer&) {
          EXPECT_TRUE(m.membership->send(protocol::Ping{}));
          m.membership->close();
        };
      },
      [](const Member&) {});
  ASSERT_EQ(map.heard[0].size(), 5u);
  EXPECT_EQ(map.heard[0][3], R"({"type":"ping"})");
}

TEST(Membership, AsksOverAnotherConnectionWhatADeafServerDoesNotTake) {
  FakeMap map;
  std::uint32_t n = 0;
  meet(
      map,
      [&n](Member& m) {
        m.on_joined = [&m, &n](Joining how) {
          if (how == Joining::again) return m.edits(1);
          // Once all is said: nothing is read meanwhile, for the server's turn has not come.
          m.timer.start({}, [&m, &n] {
            while (m.membership->joined() && n < 1'000'000)
              m.membership->look({.n = ++n, .rect = {{0, 0, 1, 1}}, .have = {}, .id = {}});
          });
        };
        m.close_after(1);
      },
      [](const Member& m) { EXPECT_EQ(m.log, "joined:0 away joined:1 ended "); });
  EXPECT_GT(n, 10'000u);
  EXPECT_EQ(json::parse(map.heard.back()[2])["n"], n);
}

TEST(Membership, AnswersAndAppliesEachEditOnceWhateverBreaks) {
  static constexpr std::size_t kEdits = 200;
  std::mt19937 random(20240607);
  FakeMap map;
  for (int i = 0; i < 12; ++i)
    map.breaks.push_back(
        {.after_messages = static_cast<int>(random() % 20), .how = static_cast<How>(random() % 3)});
  map.retry_after_ms = 1;
  meet(
      map,
      [](Member& m) {
        m.edits(16);
        m.on_answered = [&m](const Answer& answer) {
          EXPECT_EQ(answer.fate, Fate::applied);
          if (m.answers.size() + m.membership->unanswered() < kEdits) m.edits(1);
          if (m.answers.size() == kEdits) m.membership->close();
        };
      },
      [&](const Member& m) {
        ASSERT_EQ(m.answers.size(), kEdits);
        for (std::size_t i = 0; i < kEdits; ++i) {
          EXPECT_EQ(m.answers[i].id, static_cast<MessageId>(i + 1));
          EXPECT_EQ(m.answers[i].seq, 4 + i);
        }
      });
  EXPECT_EQ(map.heard.size(), 13u);
  EXPECT_EQ(map.applied.size(), kEdits);
  EXPECT_EQ(map.seq, 3 + kEdits);
}

}  // namespace
}  // namespace earthwork::link
