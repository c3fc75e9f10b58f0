#include "client/link/event_loop.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <csignal>
#include <utility>

namespace earthwork::link {

namespace asio = boost::asio;
using boost::system::error_code;

EventLoop::EventLoop() : context_(std::make_unique<asio::io_context>(1)) {}

EventLoop::~EventLoop() = default;

void EventLoop::run() {
  context_->restart();
  context_->run();
}

void EventLoop::stop() { context_->stop(); }

// A wait that has already ended when it is cancelled still calls back, without an error: `round`
// tells such a late call from the one that is meant.
struct Timer::State {
  explicit State(asio::io_context& context) : timer(context) {}
  asio::steady_timer timer;
  unsigned round = 0;
};

Timer::Timer(EventLoop& loop) : state_(std::make_shared<State>(loop.context())) {}

Timer::~Timer() { cancel(); }

void Timer::start(std::chrono::nanoseconds delay, std::function<void()> then) {
  cancel();
  state_->timer.expires_after(delay);
  state_->timer.async_wait(
      [state = state_, round = state_->round, then = std::move(then)](error_code error) {
        if (!error && state->round == round) then();
      });
}

void Timer::cancel() {
  ++state_->round;
  state_->timer.cancel();
}

struct SignalWatch::State : std::enable_shared_from_this<State> {
  State(asio::io_context& context, std::function<void()> call)
      : set(context, SIGINT, SIGTERM), then(std::move(call)) {}

  void wait() {
    set.async_wait([self = shared_from_this()](error_code error, int) {
      if (error || self->ended) return;
      self->then();
      if (!self->ended) self->wait();
    });
  }

  asio::signal_set set;
  std::function<void()> then;
  bool ended = false;
};

SignalWatch::SignalWatch(EventLoop& loop, std::function<void()> then)
    : state_(std::make_shared<State>(loop.context(), std::move(then))) {
  state_->wait();
}

SignalWatch::~SignalWatch() {
  state_->ended = true;
  error_code ignored;
  state_->set.clear(ignored);
  state_->set.cancel(ignored);
}

}  // namespace earthwork::link
