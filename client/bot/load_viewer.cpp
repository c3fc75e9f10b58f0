#include "client/bot/load_viewer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "protocol/chunk_record.hpp"

namespace earthwork::bot {
namespace {

using namespace std::chrono_literals;
using std::chrono::nanoseconds;

constexpr double kSlowBytesPerSecond = 1024;
constexpr int kSmallReceiveBytes = 16 * 1024;
constexpr auto kMaxStall = 60s;
constexpr auto kLeastStay = 100ms, kMostStay = 8000ms;  // of a flaky one
constexpr auto kLeastAway = 10ms, kMostAway = 500ms;

protocol::Hello hello() {
  protocol::Hello out;
  out.name = "load viewer";
  return out;
}

}  // namespace

LoadViewer::LoadViewer(link::EventLoop& loop, ViewerPlan plan, LoadBoard& board)
    : loop_(loop),
      plan_(std::move(plan)),
      board_(board),
      random_(plan_.seed),
      manner_timer_(loop),
      return_timer_(loop) {}

void LoadViewer::connect() {
  link::LinkOptions options{.server = plan_.server, .hello = hello(), .map = plan_.map};
  // What the system holds back for a viewer that does not read is no load on the server.
  if (plan_.manner == Manner::slow || plan_.manner == Manner::stalled)
    options.receive_buffer_bytes = kSmallReceiveBytes;
  link_ = std::make_unique<link::Link>(
      loop_, std::move(options),
      link::LinkHandlers{.ready = [this] { look(); },
                         .message = [this](const auto& message) { take(message); },
                         .frame = [this](auto& events, std::size_t bytes) { take(events, bytes); },
                         .closed = [this](const auto& closing) { closed(closing); }});
}

void LoadViewer::look() {
  const protocol::View view{.n = ++view_, .rect = {}, .have = scene_.have(), .id = {}};
  scene_.look(view.n, view.rect, settings_);
  if (const auto sent = link_->send(view); !sent) board_.tell("a viewer: " + sent.error().detail);
}

void LoadViewer::take(const protocol::ServerMessage& message) {
  if (const auto* joined = std::get_if<protocol::Joined>(&message)) {
    settings_ = joined->settings;
    const auto epoch = protocol::parse_hex(joined->epoch);
    if (!epoch) return board_.tell("a viewer: " + epoch.error().detail);
    scene_.join(*epoch, joined->seq);
  } else if (const auto* caught_up = std::get_if<protocol::CaughtUp>(&message)) {
    scene_.catch_up(caught_up->n, caught_up->seq);
    ready_ = ready_ || caught_up->n == view_;
  } else if (const auto* rejected = std::get_if<protocol::Rejected>(&message)) {
    if (!ready_) board_.fail({.cause = link::CloseCause::refused, .failure = rejected->failure});
  }
}

void LoadViewer::take(std::vector<protocol::FrameEvent>& events, std::size_t bytes) {
  if (broken_) return;
  const auto now = LoadClock::now();
  if (counting_) count(events, bytes);
  if (const auto taken = scene_.take(events, bytes); !taken) {
    board_.tell("a viewer was sent what is no picture: " + taken.error().detail);
    broken_ = true;
    return;
  }
  if (counting_ && plan_.sampled) pictures_.shown(scene_.seq(), now);
  if (bad_ && plan_.manner == Manner::slow) read_on_later(bytes);
}

void LoadViewer::count(const std::vector<protocol::FrameEvent>& events, std::size_t bytes) {
  ++counts_.frames;
  counts_.bytes += bytes;
  for (const protocol::FrameEvent& event : events) {
    if (std::holds_alternative<protocol::GroupEnd>(event))
      ++counts_.groups;
    else if (!std::holds_alternative<protocol::GroupBegin>(event))
      ++counts_.records;
  }
}

void LoadViewer::misbehave() {
  counting_ = true;
  pictures_.begin(scene_.seq());
  bad_ = plan_.manner != Manner::healthy;
  if (plan_.manner == Manner::flaky) cut_some_time();
  if (plan_.manner == Manner::stalled) {
    link_->pause_reading(true);
    manner_timer_.start(std::min<nanoseconds>(plan_.painting * 2 / 3, kMaxStall),
                        [this] { let_go(); });
  }
}

void LoadViewer::let_go() {
  if (!std::exchange(bad_, false)) return;
  manner_timer_.cancel();
  if (link_) link_->pause_reading(false);
}

void LoadViewer::match_times() {
  if (counting_ && plan_.sampled) pictures_.match(board_.sent, LoadClock::now(), counts_.view);
}

bool LoadViewer::shows(std::uint64_t seq) const {
  return scene_.complete_view() == view_ && scene_.seq() >= seq;
}

nanoseconds LoadViewer::between(nanoseconds low, nanoseconds high) {
  const double share = std::ldexp(static_cast<double>(random_() >> 11), -53);
  return low + nanoseconds(std::llround(share * static_cast<double>((high - low).count())));
}

void LoadViewer::cut_some_time() {
  const auto most = std::clamp<nanoseconds>(plan_.painting / 4, 2 * kLeastStay, kMostStay);
  manner_timer_.start(between(kLeastStay, most), [this] {
    link_.reset();
    come_back();
    cut_some_time();
  });
}

void LoadViewer::read_on_later(std::size_t bytes) {
  link_->pause_reading(true);
  const std::chrono::duration<double> wait(static_cast<double>(bytes) / kSlowBytesPerSecond);
  manner_timer_.start(std::chrono::duration_cast<nanoseconds>(wait), [this] {
    if (link_) link_->pause_reading(false);
  });
}

void LoadViewer::come_back() {
  ++counts_.reconnects;
  return_timer_.start(between(kLeastAway, kMostAway), [this] { connect(); });
}

void LoadViewer::closed(const link::Closing& closing) {
  if (closing.cause == link::CloseCause::asked) return;
  if (!ready_) return board_.fail(closing);
  if (plan_.manner == Manner::healthy) board_.tell("a viewer: " + closing.failure.detail);
  come_back();
}

}  // namespace earthwork::bot
