#include "client/link/link.hpp"

#include <cassert>
#include <utility>

#include "protocol/limits.hpp"

namespace earthwork::link {

using protocol::Code;
using protocol::Failure;
using protocol::ServerMessage;

Link::Link(EventLoop& loop, LinkOptions options, LinkHandlers handlers)
    : options_(std::move(options)),
      handlers_(std::move(handlers)),
      deadline_(loop),
      socket_(
          loop, options_.server,
          {.opened = [this] { greet(); },
           .text = [this](std::string_view text) { take_text(text); },
           .binary = [this](std::span<const std::byte> bytes) { take_binary(bytes); },
           .closed = [this](SocketEnd how, const std::string& why) { socket_closed(how, why); }},
          {.receive_buffer_bytes = options_.receive_buffer_bytes}) {}

tl::unexpected<Failure> Link::not_ready() const {
  return protocol::fail(Code::bad_state,
                        "the connection to " + options_.server.text() + " is not ready");
}

protocol::Result<void> Link::send(const protocol::ClientMessage& message) {
  if (phase_ != Phase::ready) return not_ready();
  return send_written(protocol::write(message));
}

protocol::Result<void> Link::send_written(std::string text) {
  if (phase_ != Phase::ready) return not_ready();
  if (text.size() > protocol::kMaxControlBytes)
    return protocol::fail(Code::too_large, "a message of " + std::to_string(text.size()) +
                                               " bytes is beyond the limit of " +
                                               std::to_string(protocol::kMaxControlBytes));
  if (socket_.queued_bytes() + text.size() > kMaxQueueBytes)
    return protocol::fail(Code::too_large, "messages wait that are beyond the limit of " +
                                               std::to_string(kMaxQueueBytes) + " bytes");
  socket_.write_text(std::move(text));
  return {};
}

void Link::close() { end(CloseCause::asked, {}); }

void Link::greet() {
  socket_.write_text(protocol::write(options_.hello));
  expect_answer(Phase::greeting, "hello");
}

void Link::expect_answer(Phase phase, const char* to_what) {
  phase_ = phase;
  deadline_.start(kAnswerTimeout, [this, to_what] {
    end(CloseCause::lost, {.code = Code::internal,
                           .detail = options_.server.text() + " does not answer the " + to_what,
                           .field = {}});
  });
}

void Link::take_text(std::string_view text) {
  auto message = protocol::parse_server_message(text);
  if (!message) {
    message.error().detail =
        options_.server.text() + " sent what is no message: " + message.error().detail;
    return end(CloseCause::lost, std::move(message.error()));
  }
  if (handlers_.message) handlers_.message(*message);
  if (phase_ != Phase::closing) advance(*message);
}

void Link::advance(const ServerMessage& message) {
  if (const auto* bye = std::get_if<protocol::Bye>(&message)) {
    const bool early = phase_ == Phase::greeting || phase_ == Phase::joining;
    return end(early ? CloseCause::refused : CloseCause::lost, bye->failure);
  }
  if (phase_ == Phase::ready) return;
  if (const auto* rejected = std::get_if<protocol::Rejected>(&message))
    return end(CloseCause::refused, rejected->failure);
  if (phase_ == Phase::greeting && std::holds_alternative<protocol::Welcome>(message)) {
    if (options_.map.empty()) return be_ready();
    socket_.write_text(protocol::write(protocol::Join{.map = options_.map, .seq = {}, .id = {}}));
    return expect_answer(Phase::joining, "join");
  }
  if (phase_ == Phase::joining && std::holds_alternative<protocol::Joined>(message))
    return be_ready();
}

void Link::be_ready() {
  deadline_.cancel();
  phase_ = Phase::ready;
  if (handlers_.ready) handlers_.ready();
}

void Link::take_binary(std::span<const std::byte> bytes) {
  events_.clear();
  auto taken = frames_.feed(bytes, events_);
  if (!taken) {
    taken.error().detail =
        options_.server.text() + " sent what is no frame: " + taken.error().detail;
    return end(CloseCause::lost, std::move(taken.error()));
  }
  if (handlers_.frame) handlers_.frame(events_, bytes.size());
}

void Link::end(CloseCause cause, Failure failure) {
  if (phase_ == Phase::closing) return;
  phase_ = Phase::closing;
  deadline_.cancel();
  closing_ = Closing{.cause = cause, .failure = std::move(failure)};
  socket_.close();
}

void Link::socket_closed(SocketEnd how, const std::string& why) {
  deadline_.cancel();
  if (!closing_) {
    const std::string server = options_.server.text();
    const bool never = how == SocketEnd::unreachable;
    const std::string detail = never ? server + " cannot be reached: " + why
                               : how == SocketEnd::lost
                                   ? "the connection to " + server + " was lost: " + why
                                   : server + " closed the connection";
    closing_ = Closing{.cause = never ? CloseCause::unreachable : CloseCause::lost,
                       .failure = {.code = Code::internal, .detail = detail, .field = {}}};
  }
  phase_ = Phase::closing;
  if (handlers_.closed) handlers_.closed(*closing_);
}

}  // namespace earthwork::link
