#include "client/bot/painter.hpp"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <utility>

namespace earthwork::bot {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using protocol::MessageId;

constexpr auto kGrace = 1s;       // for the answers that are due after a signal
constexpr auto kMostBehind = 1s;  // of a rate that could not be kept: the rest is not made up
constexpr std::uint64_t kToldRefusals = 10;

class Painter {
 public:
  Painter(const PaintOptions& options, std::span<const protocol::ScriptStep> steps,
          std::ostream& log)
      : options_(options), steps_(steps), log_(log), pause_(loop_), grace_(loop_) {}

  PaintReport run() {
    const link::SignalWatch signals(loop_, [this] { interrupt(); });
    protocol::Hello hello;
    hello.name = "earthwork-bot";
    link_.emplace(loop_,
                  link::LinkOptions{.server = options_.server, .hello = hello, .map = options_.map},
                  link::LinkHandlers{.ready = [this] { begin(); },
                                     .message = [this](const auto& message) { take(message); },
                                     .frame = {},
                                     .closed = [this](const auto& closing) { closed(closing); }});
    loop_.run();
    stop_clock();
    link_.reset();
    return std::move(report_);
  }

 private:
  void begin() {
    started_ = next_send_ = Clock::now();
    advance();
    finish_if_done();
  }

  /// Takes steps until one has to wait: for an answer, for the rate, or for the script.
  void advance() {
    if (pausing_ || report_.interrupted) return;
    while (next_step_ < steps_.size() && !pausing_) {
      const protocol::ScriptStep& step = steps_[next_step_];
      if (const auto* wait = std::get_if<protocol::Wait>(&step)) {
        ++next_step_;
        pause(std::chrono::milliseconds(wait->ms));
      } else if (in_flight_.size() >= options_.window || link_->congested()) {
        return;
      } else if (const auto early = next_send_ - Clock::now(); early > 0ns) {
        pause(early);
      } else {
        ++next_step_;
        send(std::get<protocol::Edit>(step));
      }
    }
  }

  void pause(std::chrono::nanoseconds duration) {
    pausing_ = true;
    pause_.start(duration, [this] {
      pausing_ = false;
      advance();
      finish_if_done();
    });
  }

  void send(const protocol::Edit& edit) {
    const MessageId id = ++last_id_;
    const Clock::time_point now = Clock::now();
    ++report_.edits;
    if (const auto sent = link_->send(protocol::EditMessage{.id = id, .edit = edit}); !sent)
      return refuse(id, sent.error());
    in_flight_.emplace(id, now);
    if (options_.edits_per_second) {
      const std::chrono::duration<double> interval(1 / *options_.edits_per_second);
      next_send_ = std::max(next_send_, now - kMostBehind) +
                   std::chrono::duration_cast<Clock::duration>(interval);
    }
  }

  void take(const protocol::ServerMessage& message) {
    if (const auto* joined = std::get_if<protocol::Joined>(&message)) {
      report_.seq = joined->seq;
    } else if (const auto* applied = std::get_if<protocol::Applied>(&message)) {
      take_applied(*applied);
    } else if (const auto* rejected = std::get_if<protocol::Rejected>(&message)) {
      if (!rejected->id || in_flight_.erase(*rejected->id) == 0) return;
      refuse(*rejected->id, rejected->failure);
      advance();
    }
    finish_if_done();
  }

  void take_applied(const protocol::Applied& applied) {
    const auto found = in_flight_.find(applied.id);
    if (found == in_flight_.end()) return;
    const Clock::time_point now = Clock::now();
    report_.ack_ms.push_back(
        std::chrono::duration<double, std::milli>(now - found->second).count());
    in_flight_.erase(found);
    ++report_.acked;
    report_.seq = std::max(report_.seq, applied.seq);
    advance();
  }

  void refuse(MessageId id, const protocol::Failure& why) {
    ++report_.rejected;
    if (report_.rejected <= kToldRefusals)
      log_ << "edit " << id << " refused: " << name(why.code) << ": " << why.detail << '\n';
    else if (report_.rejected == kToldRefusals + 1)
      log_ << "more edits refused\n";
  }

  void finish_if_done() {
    if (!started_ || !in_flight_.empty()) return;
    report_.finished = next_step_ == steps_.size() && !pausing_;
    if (report_.finished || report_.interrupted) finish();
  }

  void finish() {
    stop_clock();
    link_->close();
  }

  void interrupt() {
    const bool again = std::exchange(report_.interrupted, true);
    if (again || !started_) return loop_.stop();
    log_ << "interrupted\n";
    pause_.cancel();
    grace_.start(kGrace, [this] { loop_.stop(); });
    finish_if_done();
  }

  void closed(const link::Closing& closing) {
    if (closing.cause != link::CloseCause::asked) {
      log_ << closing.failure.detail << '\n';
      report_.broken = closing;
    }
    loop_.stop();
  }

  void stop_clock() {
    if (!started_) return;
    report_.seconds = std::chrono::duration<double>(Clock::now() - *started_).count();
    started_.reset();
  }

  const PaintOptions& options_;
  const std::span<const protocol::ScriptStep> steps_;
  std::ostream& log_;
  PaintReport report_;
  std::unordered_map<MessageId, Clock::time_point> in_flight_;  // and when they were sent
  MessageId last_id_ = 0;
  std::size_t next_step_ = 0;
  bool pausing_ = false;
  std::optional<Clock::time_point> started_;
  Clock::time_point next_send_;
  link::EventLoop loop_;
  link::Timer pause_, grace_;
  std::optional<link::Link> link_;
};

}  // namespace

PaintReport paint(const PaintOptions& options, std::span<const protocol::ScriptStep> steps,
                  std::ostream& log) {
  return Painter(options, steps, log).run();
}

std::optional<double> percentile(std::vector<double> values, double percent) {
  if (values.empty()) return std::nullopt;
  const auto count = static_cast<double>(values.size());
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(percent / 100 * count)) - 1;
  const auto at = values.begin() + std::max<std::ptrdiff_t>(rank, 0);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace earthwork::bot
