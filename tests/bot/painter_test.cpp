// The painter, against a server that the test plays: windows, refusals, and ends.
#include "client/bot/painter.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <mutex>
#include <nlohmann/json.hpp>
#include <ostream>
#include <streambuf>
#include <thread>

#include "client/bot/paint_report.hpp"
#include "protocol/messages.hpp"
#include "tests/link/fake_server.hpp"

namespace earthwork::bot {
namespace {

using link::FakeServer;
using link::Peer;
using nlohmann::json;

void greet(Peer& peer, const std::string& epoch = "00000000000000aa") {
  peer.read();
  peer.write(R"({"type":"welcome","session":"0123456789abcdef",)"
             R"("key":"0123456789abcdef0123456789abcdef","protocol":1,"limits":{}})");
  peer.read();
  peer.write(R"({"type":"joined","map":"demo","settings":{},"epoch":")" + epoch +
             R"(","seq":7,"users":[]})");
}

void apply(Peer& peer, int id, int seq) {
  peer.write(json{{"type", "applied"}, {"id", id}, {"seq", seq}}.dump());
}

std::vector<protocol::ScriptStep> edits(int count) {
  protocol::Edit edit;
  edit.path = {{1, 2}};
  return std::vector<protocol::ScriptStep>(static_cast<std::size_t>(count), edit);
}

/// What the painter tells, for the thread of the server to wait for.
class Log : public std::streambuf {
 public:
  /// Waits until a line begins with this, at most a minute; says whether it does.
  bool tells(const std::string& start) {
    std::unique_lock lock(mutex_);
    return more_.wait_for(lock, std::chrono::minutes(1),
                          [&] { return ("\n" + text_).find("\n" + start) != std::string::npos; });
  }
  std::string text() {
    const std::scoped_lock lock(mutex_);
    return text_;
  }

 private:
  int overflow(int character) override {
    const std::scoped_lock lock(mutex_);
    text_ += static_cast<char>(character);
    more_.notify_all();
    return character;
  }

  std::mutex mutex_;
  std::condition_variable more_;
  std::string text_;
};

struct Painting {
  PaintReport report;
  std::string log;
};

Painting run(std::function<void(Peer&, Log&)> play, const std::vector<protocol::ScriptStep>& steps,
             std::size_t window = 64,
             std::chrono::milliseconds patience = std::chrono::milliseconds(0)) {
  Log log;
  PaintReport report;
  {
    const FakeServer server("earthwork.v1", [&](Peer& peer) { play(peer, log); });
    std::ostream out(&log);
    const PaintOptions options{.server = server.address(),
                               .map = "demo",
                               .window = window,
                               .edits_per_second = {},
                               .patience = patience};
    report = paint(options, steps, out);
  }
  return {std::move(report), log.text()};
}

Painting run(std::function<void(Peer&)> play, const std::vector<protocol::ScriptStep>& steps,
             std::size_t window = 64) {
  return run([&play](Peer& peer, Log&) { play(peer); }, steps, window);
}

/// Of an edit of `edits` with an id of one digit, as a client's WebSocket message.
std::size_t wire_bytes() {
  const auto edit = std::get<protocol::Edit>(edits(1).front());
  const std::size_t bytes = protocol::write(protocol::EditMessage{.id = 1, .edit = edit}).size();
  return bytes + (bytes < 126 ? 6 : 8);
}

TEST(Painter, KeepsToItsWindow) {
  std::vector<std::string> heard;
  std::size_t waiting = 0;
  const Painting painting = run(
      [&](Peer& peer) {
        greet(peer);
        const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(1);
        while (peer.waiting_bytes() < 3 * wire_bytes() &&
               std::chrono::steady_clock::now() < give_up)
          std::this_thread::sleep_for(std::chrono::milliseconds(1));
        // A fourth would follow at once.
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        waiting = peer.waiting_bytes();
        for (int i = 1; i <= 3; ++i) heard.push_back(peer.read());
        for (int i = 1; i <= 2; ++i) {
          apply(peer, i, 7 + i);
          heard.push_back(peer.read());
        }
        for (int i = 3; i <= 5; ++i) apply(peer, i, 7 + i);
        heard.push_back(peer.read());
      },
      edits(5), 3);
  ASSERT_EQ(heard.size(), 6u);
  EXPECT_EQ(waiting, 3 * wire_bytes());
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(json::parse(heard[static_cast<std::size_t>(i)])["id"], i + 1);
  EXPECT_EQ(heard[5], "closed 1000");
  EXPECT_EQ(painting.report.edits, 5u);
  EXPECT_EQ(painting.report.acked, 5u);
  EXPECT_EQ(painting.report.seq, 12u);
  EXPECT_EQ(painting.report.ack_ms.size(), 5u);
  EXPECT_TRUE(painting.report.finished);
  EXPECT_EQ(exit_code(painting.report), kDone);
}

TEST(Painter, CountsRefusalsAndTellsTheFirstTen) {
  const Painting painting = run(
      [](Peer& peer) {
        greet(peer);
        for (int i = 1; i <= 12; ++i) {
          peer.read();
          peer.write(json{{"type", "rejected"},
                          {"id", i},
                          {"code", "out_of_range"},
                          {"message", "radius: too large"}}
                         .dump());
        }
        peer.read();
      },
      edits(12));
  EXPECT_EQ(painting.report.rejected, 12u);
  EXPECT_EQ(painting.report.acked, 0u);
  EXPECT_EQ(painting.report.seq, 7u);
  EXPECT_TRUE(painting.log.starts_with("edit 1 refused: out_of_range: radius: too large\n"));
  EXPECT_TRUE(
      painting.log.ends_with("edit 10 refused: out_of_range: radius: too large\n"
                             "more edits refused\n"));
  EXPECT_EQ(exit_code(painting.report), kFailed);
}

TEST(Painter, HasNothingToWaitForInAnEmptyScript) {
  const Painting painting = run(
      [](Peer& peer) {
        greet(peer);
        EXPECT_EQ(peer.read(), "closed 1000");
      },
      {});
  EXPECT_TRUE(painting.report.finished);
  EXPECT_EQ(exit_code(painting.report), kDone);
}

TEST(Painter, IgnoresRepliesToWhatItNeverSent) {
  const Painting painting = run(
      [](Peer& peer) {
        greet(peer);
        peer.read();
        apply(peer, 99, 50);
        apply(peer, 1, 8);
        apply(peer, 1, 60);
        peer.read();
      },
      edits(1));
  EXPECT_EQ(painting.report.acked, 1u);
  EXPECT_EQ(painting.report.seq, 8u);
}

TEST(Painter, ReportsWhatItHasWhenTheServerGoesAway) {
  const Painting painting = run(
      [](Peer& peer) {
        greet(peer);
        peer.read();
        apply(peer, 1, 8);
        peer.write(R"({"type":"bye","code":"internal","message":"the disk is full"})");
        peer.close(1011);
      },
      edits(3));
  EXPECT_EQ(painting.report.acked, 1u);
  EXPECT_FALSE(painting.report.finished);
  EXPECT_EQ(painting.log, "the disk is full\n");
  EXPECT_EQ(exit_code(painting.report), kFailed);
}

TEST(Painter, HasNothingToTalkToWithoutItsMap) {
  const Painting painting = run(
      [](Peer& peer) {
        peer.read();
        peer.write(R"({"type":"rejected","code":"unknown_map","message":"no such map"})");
        peer.read();
      },
      edits(3));
  EXPECT_EQ(painting.log, "no such map\n");
  EXPECT_EQ(painting.report.edits, 0u);
  EXPECT_EQ(exit_code(painting.report), kUsage);
}

/// A first connection that breaks after its first edit was answered, and another one.
Painting run_twice(const std::function<void(Peer&)>& second, int count) {
  int connections = 0;
  return run(
      [&](Peer& peer, Log&) {
        if (++connections > 1) return second(peer);
        greet(peer);
        peer.read();
        apply(peer, 1, 8);
        peer.write(R"({"type":"bye","code":"internal","message":"the disk is full"})");
        peer.close(1011);
      },
      edits(count), 64, std::chrono::minutes(1));
}

TEST(Painter, GoesOnOverAnotherConnection) {
  std::vector<std::string> heard;
  const Painting painting = run_twice(
      [&](Peer& peer) {
        greet(peer);
        for (int i = 2; i <= 3; ++i) {
          heard.push_back(peer.read());
          apply(peer, i, 7 + i);
        }
        peer.read();
      },
      3);
  ASSERT_EQ(heard.size(), 2u);
  EXPECT_EQ(json::parse(heard[0])["id"], 2);
  EXPECT_EQ(json::parse(heard[1])["id"], 3);
  EXPECT_EQ(painting.report.edits, 3u);
  EXPECT_EQ(painting.report.acked, 3u);
  EXPECT_EQ(painting.report.seq, 10u);
  EXPECT_EQ(painting.log, "the disk is full; trying again\njoined again\n");
  EXPECT_EQ(exit_code(painting.report), kDone);
}

TEST(Painter, DoesNotGoOnInAnotherMap) {
  std::string heard;
  const Painting painting = run_twice(
      [&](Peer& peer) {
        greet(peer, "00000000000000bb");
        heard = peer.read();
      },
      3);
  EXPECT_EQ(heard, "closed 1000");
  EXPECT_EQ(painting.report.edits, 3u);
  EXPECT_EQ(painting.report.acked, 1u);
  EXPECT_EQ(painting.report.rejected, 0u);
  EXPECT_TRUE(painting.log.ends_with("map: demo was made anew, this is another one\n"));
  EXPECT_EQ(exit_code(painting.report), kFailed);
}

TEST(Painter, ReportsWhatItHasWhenTheMapIsGone) {
  const Painting painting = run_twice(
      [](Peer& peer) {
        peer.read();
        peer.write(R"({"type":"welcome","session":"0123456789abcdef",)"
                   R"("key":"0123456789abcdef0123456789abcdef","protocol":1,"limits":{}})");
        peer.read();
        peer.write(R"({"type":"rejected","code":"unknown_map","message":"no such map"})");
        peer.read();
      },
      2);
  EXPECT_EQ(painting.report.acked, 1u);
  EXPECT_EQ(painting.log, "the disk is full; trying again\nno such map\n");
  EXPECT_EQ(exit_code(painting.report), kFailed);
}

TEST(Painter, WaitsForTheAnswersThatAreDueAfterASignal) {
  std::vector<std::string> heard;
  const Painting painting = run(
      [&](Peer& peer, Log& log) {
        greet(peer);
        heard.push_back(peer.read());
        std::raise(SIGTERM);
        EXPECT_TRUE(log.tells("interrupted\n"));
        apply(peer, 1, 8);
        heard.push_back(peer.read());
      },
      edits(3), 1);
  EXPECT_TRUE(painting.report.interrupted);
  EXPECT_EQ(painting.report.edits, 1u);
  EXPECT_EQ(painting.report.acked, 1u);
  EXPECT_EQ(heard.back(), "closed 1000");
  EXPECT_EQ(painting.log, "interrupted\n");
  EXPECT_EQ(exit_code(painting.report), kFailed);
}

TEST(Painter, EndsAtASecondSignalWithoutItsAnswers) {
  const Painting painting = run(
      [](Peer& peer, Log& log) {
        greet(peer);
        peer.read();
        std::raise(SIGINT);
        EXPECT_TRUE(log.tells("interrupted\n"));
        std::raise(SIGINT);
        peer.read();
      },
      edits(1));
  EXPECT_TRUE(painting.report.interrupted);
  EXPECT_EQ(painting.report.acked, 0u);
}

TEST(Percentile, IsTheNearestRank) {
  EXPECT_EQ(percentile({}, 50), std::nullopt);
  EXPECT_EQ(percentile({3}, 99), 3);
  EXPECT_EQ(percentile({4, 1, 3, 2}, 50), 2);
  EXPECT_EQ(percentile({4, 1, 3, 2}, 51), 3);
  EXPECT_EQ(percentile({4, 1, 3, 2}, 100), 4);
}

TEST(PaintReport, WritesNoLatencyWhereNothingWasApplied) {
  PaintReport report;
  report.edits = 3;
  report.seq = 9;
  EXPECT_EQ(write_report(report).dump(),
            R"({"edits":3,"acked":0,"rejected":0,"seconds":0.0,"ack_p50_ms":null,)"
            R"("ack_p99_ms":null,"seq":9})");
  report.ack_ms = {2.0, 1.0};
  EXPECT_EQ(write_report(report)["ack_p50_ms"], 1.0);
  EXPECT_EQ(write_report(report)["ack_p99_ms"], 2.0);
}

}  // namespace
}  // namespace earthwork::bot
