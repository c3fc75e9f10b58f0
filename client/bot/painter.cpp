#include "client/bot/painter.hpp"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <unordered_map>
#include <utility>

#include "client/link/event_loop.hpp"
#include "client/link/membership.hpp"

namespace earthwork::bot {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

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
    membership_.emplace(
        loop_,
        link::MembershipOptions{.server = options_.server,
                                .map = options_.map,
                                .resume = {.hello = hello, .patience = options_.patience}},
        link::MembershipHandlers{
            .joined = [this](const auto& joined, auto how) { take_joined(joined, how); },
            .have = {},
            .answered = [this](const auto& answer) { take(answer); },
            .message = {},
            .frame = {},
            .lost = [this](const auto& why, auto) { tell_lost(why); },
            .ended = [this](const auto& closing) { ended(closing); }});
    loop_.run();
    stop_clock();
    membership_.reset();
    return std::move(report_);
  }

 private:
  struct InFlight {
    std::uint64_t number = 0;  // of the script's edits
    Clock::time_point since;
  };

  void take_joined(const protocol::Joined& joined, link::Joining how) {
    if (how == link::Joining::again) {
      log_ << "joined again\n";
    } else if (how == link::Joining::another_map) {
      give_up({.code = protocol::Code::unknown_map,
               .detail = "map: " + options_.map + " was made anew, this is another one",
               .field = "map"});
    } else {
      report_.joined = true;
      report_.seq = joined.seq;
      started_ = next_send_ = Clock::now();
      advance();
      finish_if_done();
    }
    told_lost_ = false;
  }

  /// Takes steps until one has to wait: for an answer, for the rate, or for the script.
  void advance() {
    if (pausing_ || report_.interrupted) return;
    while (next_step_ < steps_.size() && !pausing_) {
      const protocol::ScriptStep& step = steps_[next_step_];
      if (const auto* wait = std::get_if<protocol::Wait>(&step)) {
        ++next_step_;
        pause(std::chrono::milliseconds(wait->ms));
      } else if (in_flight_.size() >= options_.window || membership_->congested()) {
        return;
      } else if (const auto early = next_send_ - Clock::now(); early > 0ns) {
        pause(early);
      } else {
        ++next_step_;
        if (const auto* edit = std::get_if<protocol::Edit>(&step))
          send(*edit);
        else
          send(std::get<protocol::LayerChange>(step));
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

  template <class Asked>
  void send(const Asked& asked) {
    const Clock::time_point now = Clock::now();
    ++report_.edits;
    const auto id = membership_->edit(asked);
    if (!id) return refuse(report_.edits, id.error());
    in_flight_.emplace(*id, InFlight{.number = report_.edits, .since = now});
    if (options_.edits_per_second) {
      const std::chrono::duration<double> interval(1 / *options_.edits_per_second);
      next_send_ = std::max(next_send_, now - kMostBehind) +
                   std::chrono::duration_cast<Clock::duration>(interval);
    }
  }

  void take(const link::Answer& answer) {
    const auto found = in_flight_.find(answer.id);
    if (found == in_flight_.end()) return;
    const InFlight edit = found->second;
    in_flight_.erase(found);
    if (answer.fate == link::Fate::lost) return;  // what ends it all is told by itself
    if (answer.fate == link::Fate::rejected) {
      refuse(edit.number, answer.why);
    } else {
      const std::chrono::duration<double, std::milli> took = Clock::now() - edit.since;
      report_.ack_ms.push_back(took.count());
      report_.seq = report_.acked++ == 0 ? answer.seq : std::max(report_.seq, answer.seq);
    }
    advance();
    finish_if_done();
  }

  void refuse(std::uint64_t number, const protocol::Failure& why) {
    ++report_.rejected;
    if (report_.rejected <= kToldRefusals)
      log_ << "edit " << number << " refused: " << name(why.code) << ": " << why.detail << '\n';
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
    membership_->close();
  }

  void interrupt() {
    const bool again = std::exchange(report_.interrupted, true);
    if (again || !started_) return loop_.stop();
    log_ << "interrupted\n";
    pause_.cancel();
    grace_.start(kGrace, [this] { loop_.stop(); });
    finish_if_done();
  }

  /// Once for all that is tried until the next join.
  void tell_lost(const link::Closing& why) {
    if (!std::exchange(told_lost_, true)) log_ << why.failure.detail << "; trying again\n";
  }

  void give_up(protocol::Failure why) {
    log_ << why.detail << '\n';
    report_.broken = link::Closing{.cause = link::CloseCause::lost, .failure = std::move(why)};
    finish();
  }

  void ended(const link::Closing& closing) {
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
  std::unordered_map<protocol::MessageId, InFlight> in_flight_;
  std::size_t next_step_ = 0;
  bool pausing_ = false;
  bool told_lost_ = false;  // and not joined since
  std::optional<Clock::time_point> started_;
  Clock::time_point next_send_;
  link::EventLoop loop_;
  link::Timer pause_, grace_;
  std::optional<link::Membership> membership_;
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
