#include "client/viewer/session.hpp"

#include <algorithm>
#include <utility>

namespace earthwork::viewer {

using link::CloseCause;
using protocol::Code;
using protocol::Failure;
using protocol::MessageId;
using protocol::Result;
using std::chrono::milliseconds;

namespace {

link::ResumeOptions patient(protocol::Hello hello, MessageId last_id) {
  return {.hello = std::move(hello),
          .last_id = last_id,
          .patience = std::nullopt,
          .first_try = link::FirstTry::may_fail};
}

Failure no_answer(const char* to_what) {
  return {.code = Code::timeout, .detail = std::string("no answer to the ") + to_what, .field = {}};
}

/// For people, of the end of a connection.
std::string sentence(const link::Closing& closing) {
  const std::string& detail = closing.failure.detail;
  switch (closing.failure.code) {
    case Code::unknown_map:
      return "This map is not there, or was deleted.";
    case Code::bad_version:
      return "The server speaks another version: load the page again.";
    case Code::shutting_down:
      return "The server ends or starts anew.";
    default:
      break;
  }
  if (closing.cause == CloseCause::unreachable) return "The server cannot be reached.";
  if (closing.cause == CloseCause::refused) return "The server refused: " + detail;
  return "The connection was lost" + (detail.empty() ? "." : ": " + detail);
}

}  // namespace

Session::Session(Shell& shell, SessionOwner& owner, Options options, Time now)
    : shell_(shell),
      owner_(owner),
      map_(std::move(options.map)),
      name_(options.hello.name),
      color_(options.hello.color),
      seed_(options.seed),
      last_id_(options.last_id),
      resume_(patient(std::move(options.hello), options.last_id), options.seed, now) {
  connect(now);
}

void Session::connect(Time now) {
  phase_ = Phase::connecting;
  deadline_ = now + kAnswerTimeout;
  frames_ = {};
  ping_unanswered_ = false;
  latency_ms_.reset();
  shell_.connect();
}

void Session::connected(Time now) {
  if (phase_ != Phase::connecting) return;
  phase_ = Phase::greeting;
  deadline_ = now + kAnswerTimeout;
  protocol::Hello hello = resume_.hello();
  hello.name = name_;
  hello.color = color_;
  shell_.send(protocol::write(hello));
}

bool Session::listening() const {
  return phase_ == Phase::greeting || phase_ == Phase::joining || phase_ == Phase::live;
}

void Session::text(std::string_view message, Time now) {
  if (!listening()) return;
  heard_ = now;
  bytes_ += message.size();
  auto parsed = protocol::parse_server_message(message);
  if (parsed) return take(*parsed, now);
  Failure& why = parsed.error();
  // Later versions may say more than this one knows.
  if (why.code == Code::bad_message && why.field == "type") return;
  drop(CloseCause::lost, {Code::bad_message, "what came is no message: " + why.detail, {}}, now);
}

void Session::take(const protocol::ServerMessage& message, Time now) {
  if (const auto* bye = std::get_if<protocol::Bye>(&message)) {
    static_cast<void>(resume_.take(message));
    return drop(phase_ == Phase::live ? CloseCause::lost : CloseCause::refused, bye->failure, now);
  }
  if (phase_ == Phase::live) return take_live(message, now);
  if (const auto* rejected = std::get_if<protocol::Rejected>(&message))
    return drop(CloseCause::refused, rejected->failure, now);
  const auto* welcome = std::get_if<protocol::Welcome>(&message);
  if (phase_ == Phase::greeting && welcome) {
    resume_.take_welcome(*welcome);
    id_ = welcome->session;
    phase_ = Phase::joining;
    deadline_ = now + kAnswerTimeout;
    return shell_.send(protocol::write(protocol::Join{.map = map_, .seq = {}, .id = {}}));
  }
  const auto* joined = std::get_if<protocol::Joined>(&message);
  if (phase_ == Phase::joining && joined) enter(*joined, now);
}

// What is asked for in `joined` is not sent by itself: the phase is not live yet, and the opening
// has it, behind what is sent again and in the order of the ids.
void Session::enter(const protocol::Joined& joined, Time now) {
  const auto entrance = resume_.take_joined(joined, now);
  hand_back(entrance.lost);
  owner_.joined(joined, entrance.joining);
  std::optional<protocol::Have> have;
  if (resume_.looks()) have = owner_.have();
  phase_ = Phase::live;
  was_lost_ = false;
  words_.clear();
  for (const std::string& text : resume_.opening(std::move(have))) shell_.send(text);
  ping_sent_ = now - kPingEvery;
  watch(now);
}

void Session::take_live(const protocol::ServerMessage& message, Time now) {
  const auto* done = std::get_if<protocol::Done>(&message);
  if (done && done->id == kPingId && std::exchange(ping_unanswered_, false)) {
    latency_ms_ = std::chrono::duration<double, std::milli>(now - ping_sent_).count();
    return watch(now);
  }
  if (std::holds_alternative<protocol::Welcome>(message) ||
      std::holds_alternative<protocol::Joined>(message))
    return;  // asked for by nobody
  if (const auto answer = resume_.take(message))
    owner_.answered({*answer});
  else
    owner_.told(message);
}

void Session::binary(std::span<const std::byte> message, Time now) {
  if (phase_ != Phase::live) return;
  heard_ = now;
  bytes_ += message.size();
  resume_.take_frame();
  events_.clear();
  auto taken = frames_.feed(message, events_);
  if (taken) taken = owner_.shown(events_, message.size());
  if (taken) return;
  drop(CloseCause::lost, {Code::bad_frame, "what came is no frame: " + taken.error().detail, {}},
       now);
}

void Session::disconnected(int code, std::string_view reason, Time now) {
  if (phase_ == Phase::waiting || phase_ == Phase::ended) return;
  std::string detail = reason.empty() ? "closed with code " + std::to_string(code) : "";
  detail += reason;
  end({.cause = phase_ == Phase::connecting ? CloseCause::unreachable : CloseCause::lost,
       .failure = {Code::internal, std::move(detail), {}}},
      now);
}

std::optional<Session::Time> Session::due() const {
  if (phase_ == Phase::ended) return std::nullopt;
  return deadline_;
}

void Session::tick(Time now) {
  if (phase_ == Phase::ended || now < deadline_) return;
  switch (phase_) {
    case Phase::waiting:
      return connect(now);
    case Phase::connecting:
      return drop(CloseCause::unreachable, no_answer("call"), now);
    case Phase::greeting:
      return drop(CloseCause::lost, no_answer("hello"), now);
    case Phase::joining:
      return drop(CloseCause::lost, no_answer("join"), now);
    case Phase::live:
      return watch(now);
    case Phase::ended:
      break;
  }
}

/// Of a live connection: asks whether it is still there, and judges by what came since.
void Session::watch(Time now) {
  if (ping_unanswered_ && now - std::max(heard_, ping_sent_) >= kSilence)
    return drop(CloseCause::lost, no_answer("ping"), now);
  if (!ping_unanswered_ && now - ping_sent_ >= kPingEvery) {
    ping_unanswered_ = true;
    ping_sent_ = now;
    shell_.send(protocol::write(protocol::Ping{.id = kPingId}));
  }
  deadline_ = ping_unanswered_ ? std::max(heard_, ping_sent_) + kSilence : ping_sent_ + kPingEvery;
}

Result<MessageId> Session::edit(const protocol::Edit& edit) {
  if (phase_ == Phase::ended) return protocol::fail(Code::bad_state, words_);
  return keep(resume_.add(edit));
}

Result<MessageId> Session::change(const protocol::LayerChange& change) {
  if (phase_ == Phase::ended) return protocol::fail(Code::bad_state, words_);
  return keep(resume_.add(change));
}

Result<MessageId> Session::keep(Result<link::Unanswered::Kept> kept) {
  if (!kept) return tl::unexpected(std::move(kept.error()));
  last_id_ = std::max(last_id_, kept->id);
  if (phase_ == Phase::live) shell_.send(kept->message);
  return kept->id;
}

void Session::look(const protocol::View& view) {
  const std::string text = resume_.look(view);
  if (phase_ == Phase::live) shell_.send(text);
}

bool Session::say(const protocol::ClientMessage& message) {
  if (phase_ != Phase::live) return false;
  shell_.send(protocol::write(message));
  return true;
}

void Session::open(std::string map, Time now) {
  shell_.disconnect();
  hand_back(resume_.give_up({Code::internal, "not confirmed before the map was left", {}}));
  map_ = std::move(map);
  was_lost_ = false;
  resume_ = link::Resume(patient(resume_.hello(), last_id_), ++seed_, now);
  connect(now);
}

void Session::be(std::string name, std::string color, Time now) {
  name_ = std::move(name);
  color_ = std::move(color);
  reconnect(now);
}

void Session::retry(Time now) {
  if (phase_ == Phase::waiting || phase_ == Phase::ended) connect(now);
}

void Session::reconnect(Time now) {
  shell_.disconnect();
  static_cast<void>(resume_.take_end({.cause = CloseCause::asked, .failure = {}}, now));
  connect(now);
}

void Session::drop(CloseCause cause, Failure failure, Time now) {
  shell_.disconnect();
  end({.cause = cause, .failure = std::move(failure)}, now);
}

void Session::end(const link::Closing& closing, Time now) {
  words_ = sentence(closing);
  was_lost_ = true;
  latency_ms_.reset();
  const auto delay = resume_.take_end(closing, now);
  phase_ = delay ? Phase::waiting : Phase::ended;
  if (delay) deadline_ = now + *delay;
  if (!delay) hand_back(resume_.give_up(closing.failure));
}

void Session::hand_back(const std::vector<link::Answer>& answers) {
  if (!answers.empty()) owner_.answered(answers);
}

std::optional<Session::Time> Session::retry_at() const {
  if (phase_ != Phase::waiting) return std::nullopt;
  return deadline_;
}

ConnectionPart Session::part(Time now) const {
  using State = ConnectionPart::State;
  ConnectionPart part;
  part.key = resume_.hello().key.value_or("");
  part.session = id_;
  part.words = words_;
  if (phase_ == Phase::live) {
    part.state = State::joined;
    part.words = "Connected.";
  } else if (phase_ == Phase::ended) {
    part.state = State::ended;
  } else if (!was_lost_) {
    part.words = "Connecting.";
  } else {
    part.state = State::lost;
    if (const auto at = retry_at())
      part.retry_ms =
          std::chrono::ceil<milliseconds>(std::max(*at - now, Time::duration::zero())).count();
  }
  return part;
}

}  // namespace earthwork::viewer
