#include "client/link/membership.hpp"

#include <random>
#include <utility>

namespace earthwork::link {

using protocol::Code;
using protocol::Failure;
using Clock = std::chrono::steady_clock;

namespace {

std::uint64_t random_seed() {
  std::random_device device;
  return (std::uint64_t{device()} << 32) | device();
}

tl::unexpected<Failure> ended_already() {
  return protocol::fail(Code::bad_state, "the part in the map has ended");
}

}  // namespace

Membership::Membership(EventLoop& loop, MembershipOptions options, MembershipHandlers handlers)
    : loop_(loop),
      options_(std::move(options)),
      handlers_(std::move(handlers)),
      resume_(options_.resume, options_.seed ? *options_.seed : random_seed(), Clock::now()),
      next_(loop) {
  connect();
}

void Membership::connect() {
  linked_ = true;
  cutting_ = false;
  link_.emplace(loop_,
                LinkOptions{.server = options_.server,
                            .hello = resume_.hello(),
                            .map = options_.map,
                            .receive_buffer_bytes = options_.receive_buffer_bytes},
                LinkHandlers{.ready = [this] { enter(); },
                             .message = [this](const auto& message) { take(message); },
                             .frame =
                                 [this](auto& events, std::size_t bytes) {
                                   if (cutting_) return;
                                   resume_.take_frame();
                                   if (handlers_.frame) handlers_.frame(events, bytes);
                                 },
                             .closed = [this](const auto& closing) { link_closed(closing); }});
}

protocol::Result<protocol::MessageId> Membership::edit(const protocol::Edit& edit) {
  if (closing_) return ended_already();
  return send_kept(resume_.add(edit));
}

protocol::Result<protocol::MessageId> Membership::edit(const protocol::LayerChange& change) {
  if (closing_) return ended_already();
  return send_kept(resume_.add(change));
}

protocol::Result<protocol::MessageId> Membership::send_kept(
    const protocol::Result<Unanswered::Kept>& added) {
  if (!added) return tl::unexpected<Failure>(added.error());
  if (live_) say(std::string(added->message));
  return added->id;
}

void Membership::look(const protocol::View& view) {
  std::string text = resume_.look(view);
  if (live_) say(std::move(text));
}

// A link that is ending by itself takes nothing, and a server that has taken nothing for as long as
// it needs to fill the queue is as good as gone: what was to be said is said over the next one.
void Membership::say(std::string text) {
  if (!link_->send_written(std::move(text)) && link_->congested()) cut();
}

protocol::Result<void> Membership::send(const protocol::ClientMessage& message) {
  if (!live_) return protocol::fail(Code::bad_state, "no map is joined now");
  if (link_->congested())
    return protocol::fail(Code::too_large, "messages wait that are beyond the limit of " +
                                               std::to_string(kQueueHighWaterBytes) + " bytes");
  return link_->send(message);
}

void Membership::take(const protocol::ServerMessage& message) {
  if (cutting_) return;
  if (const auto* welcome = std::get_if<protocol::Welcome>(&message))
    resume_.take_welcome(*welcome);
  if (const auto* joined = std::get_if<protocol::Joined>(&message)) joined_ = *joined;
  const auto answer = resume_.take(message);
  if (handlers_.message) handlers_.message(message);
  if (answer && handlers_.answered) handlers_.answered(*answer);
}

// Edits that are made in the handlers have larger ids than those that are sent again, so nothing is
// sent before the handlers have returned.
void Membership::enter() {
  if (cutting_) return;
  const auto entrance = resume_.take_joined(*joined_, Clock::now());
  hand_back(entrance.lost);
  if (handlers_.joined) handlers_.joined(*joined_, entrance.joining);
  if (closing_ || cutting_) return;
  std::optional<protocol::Have> have;
  if (resume_.looks() && handlers_.have) have = handlers_.have();
  live_ = true;
  for (std::string& text : resume_.opening(std::move(have))) say(std::move(text));
}

void Membership::pause_reading(bool paused) {
  if (linked_) link_->pause_reading(paused);
}

void Membership::cut() {
  if (!linked_ || closing_) return;
  cutting_ = true;
  live_ = false;
  next_.start({}, [this] {
    link_.reset();
    link_closed({.cause = CloseCause::lost,
                 .failure = {.code = Code::internal,
                             .detail = "the connection to " + options_.server.text() + " was cut",
                             .field = {}}});
  });
}

void Membership::close() {
  if (std::exchange(closing_, true)) return;
  live_ = false;
  if (linked_ && !cutting_)
    link_->close();
  else
    next_.start({}, [this] {
      link_.reset();
      end({.cause = CloseCause::asked, .failure = {}});
    });
}

void Membership::link_closed(const Closing& closing) {
  linked_ = live_ = false;
  next_.cancel();
  if (closing_) return end({.cause = CloseCause::asked, .failure = {}});
  const auto delay = resume_.take_end(closing, Clock::now());
  if (!delay) return end(closing);
  next_.start(*delay, [this] { connect(); });
  if (handlers_.lost) handlers_.lost(closing, *delay);
}

void Membership::hand_back(const std::vector<Answer>& answers) {
  for (const Answer& answer : answers)
    if (handlers_.answered) handlers_.answered(answer);
}

void Membership::end(const Closing& closing) {
  linked_ = live_ = false;
  closing_ = true;
  const Failure unheard{
      .code = Code::internal, .detail = "it ended before the server answered", .field = {}};
  hand_back(resume_.give_up(closing.cause == CloseCause::asked ? unheard : closing.failure));
  if (handlers_.ended) handlers_.ended(closing);
}

}  // namespace earthwork::link
