#include "client/bot/watcher.hpp"

#include <ostream>
#include <utility>
#include <vector>

#include "client/link/event_loop.hpp"
#include "client/link/membership.hpp"

namespace earthwork::bot {
namespace {

constexpr std::uint32_t kView = 1;  // the only one
const protocol::View kAll{.n = kView, .rect = {}, .have = {}, .id = {}};

class Watcher {
 public:
  Watcher(const WatchOptions& options, std::ostream& log)
      : options_(options), log_(log), limit_(loop_) {}

  WatchReport run() {
    const link::SignalWatch signals(loop_, [this] { loop_.stop(); });
    protocol::Hello hello;
    hello.name = "earthwork-bot";
    membership_.emplace(
        loop_,
        link::MembershipOptions{.server = options_.server,
                                .map = options_.map,
                                .resume = {.hello = hello, .patience = options_.patience}},
        link::MembershipHandlers{
            .joined = [this](const auto& joined, auto how) { take_joined(joined, how); },
            .have = [this] { return report_.scene.have(); },
            .answered = {},
            .message = [this](const auto& message) { take(message); },
            .frame = [this](auto& events, std::size_t bytes) { take(events, bytes); },
            .lost = [this](const auto& why, auto) { tell_lost(why); },
            .ended = [this](const auto& closing) { ended(closing); }});
    membership_->look(kAll);
    loop_.run();
    membership_.reset();
    report_.complete = complete();
    return std::move(report_);
  }

 private:
  bool complete() const {
    return report_.scene.complete_view() == kView &&
           report_.scene.seq() >= options_.until_seq.value_or(0);
  }

  void take_joined(const protocol::Joined& joined, link::Joining how) {
    if (how != link::Joining::first) log_ << "joined again\n";
    const bool first = !std::exchange(report_.joined, true);
    if (first && options_.time_limit)
      limit_.start(*options_.time_limit, [this] { membership_->close(); });
    away_.reset();
    report_.settings = joined.settings;
    const auto epoch = protocol::parse_hex(joined.epoch);
    if (!epoch) return give_up(epoch.error());
    report_.scene.join(*epoch, joined.seq);
    report_.scene.look(kView, kAll.rect, joined.settings);
  }

  void take(const protocol::ServerMessage& message) {
    if (const auto* caught_up = std::get_if<protocol::CaughtUp>(&message)) {
      report_.scene.catch_up(caught_up->n, caught_up->seq);
      end_if_complete();
    } else if (const auto* changed = std::get_if<protocol::SettingsChanged>(&message)) {
      report_.settings = changed->settings;
    } else if (const auto* rejected = std::get_if<protocol::Rejected>(&message)) {
      if (membership_->joined()) give_up(rejected->failure);  // a join that is refused ends it
    }
  }

  void take(std::vector<protocol::FrameEvent>& events, std::size_t bytes) {
    if (const auto taken = report_.scene.take(events, bytes); !taken) return give_up(taken.error());
    end_if_complete();
  }

  void end_if_complete() {
    const bool only_a_time_limit = options_.time_limit && !options_.until_seq;
    if (complete() && !only_a_time_limit) membership_->close();
  }

  void give_up(const protocol::Failure& why) {
    log_ << why.detail << '\n';
    report_.broken = link::Closing{.cause = link::CloseCause::lost, .failure = why};
    membership_->close();
  }

  /// Once for all that is tried until the next join.
  void tell_lost(const link::Closing& why) {
    if (!away_) log_ << why.failure.detail << "; trying again\n";
    away_ = why;
  }

  void ended(const link::Closing& closing) {
    if (closing.cause != link::CloseCause::asked) {
      log_ << closing.failure.detail << '\n';
      report_.broken = closing;
    } else if (away_ && !report_.broken) {
      report_.broken = away_;  // what it has may be old
    }
    loop_.stop();
  }

  const WatchOptions& options_;
  std::ostream& log_;
  WatchReport report_;
  std::optional<link::Closing> away_;  // why there is no connection now
  link::EventLoop loop_;
  link::Timer limit_;
  std::optional<link::Membership> membership_;
};

}  // namespace

WatchReport watch(const WatchOptions& options, std::ostream& log) {
  return Watcher(options, log).run();
}

}  // namespace earthwork::bot
