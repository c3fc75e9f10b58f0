#include "client/bot/watcher.hpp"

#include <ostream>
#include <utility>
#include <vector>

#include "client/link/event_loop.hpp"

namespace earthwork::bot {
namespace {

constexpr std::uint32_t kView = 1;  // the only one

class Watcher {
 public:
  Watcher(const WatchOptions& options, std::ostream& log)
      : options_(options), log_(log), limit_(loop_) {}

  WatchReport run() {
    const link::SignalWatch signals(loop_, [this] { loop_.stop(); });
    protocol::Hello hello;
    hello.name = "earthwork-bot";
    link_.emplace(loop_,
                  link::LinkOptions{.server = options_.server, .hello = hello, .map = options_.map},
                  link::LinkHandlers{
                      .ready = [this] { look(); },
                      .message = [this](const auto& message) { take(message); },
                      .frame = [this](auto& events, std::size_t bytes) { take(events, bytes); },
                      .closed = [this](const auto& closing) { closed(closing); }});
    loop_.run();
    link_.reset();
    report_.complete = complete();
    return std::move(report_);
  }

 private:
  bool complete() const {
    return report_.scene.complete_view() == kView &&
           report_.scene.seq() >= options_.until_seq.value_or(0);
  }

  void look() {
    if (options_.time_limit) limit_.start(*options_.time_limit, [this] { link_->close(); });
    const auto sent = link_->send(protocol::View{.n = kView, .rect = {}, .have = {}, .id = {}});
    if (!sent) give_up(sent.error());
    looking_ = true;
  }

  void take(const protocol::ServerMessage& message) {
    if (const auto* joined = std::get_if<protocol::Joined>(&message)) {
      report_.settings = joined->settings;
      const auto epoch = protocol::parse_hex(joined->epoch);
      if (!epoch) return give_up(epoch.error());
      report_.scene.join(*epoch);
    } else if (const auto* caught_up = std::get_if<protocol::CaughtUp>(&message)) {
      report_.scene.catch_up(caught_up->n, caught_up->seq);
      end_if_complete();
    } else if (const auto* rejected = std::get_if<protocol::Rejected>(&message)) {
      if (looking_) give_up(rejected->failure);  // the link tells of a join that was refused
    }
  }

  void take(std::vector<protocol::FrameEvent>& events, std::size_t bytes) {
    if (const auto taken = report_.scene.take(events, bytes); !taken) return give_up(taken.error());
    end_if_complete();
  }

  void end_if_complete() {
    const bool only_a_time_limit = options_.time_limit && !options_.until_seq;
    if (complete() && !only_a_time_limit) link_->close();
  }

  void give_up(const protocol::Failure& why) {
    log_ << why.detail << '\n';
    report_.broken = link::Closing{.cause = link::CloseCause::lost, .failure = why};
    link_->close();
  }

  void closed(const link::Closing& closing) {
    if (closing.cause != link::CloseCause::asked) {
      log_ << closing.failure.detail << '\n';
      report_.broken = closing;
    }
    loop_.stop();
  }

  const WatchOptions& options_;
  std::ostream& log_;
  WatchReport report_;
  bool looking_ = false;  // the view was asked for
  link::EventLoop loop_;
  link::Timer limit_;
  std::optional<link::Link> link_;
};

}  // namespace

WatchReport watch(const WatchOptions& options, std::ostream& log) {
  return Watcher(options, log).run();
}

}  // namespace earthwork::bot
