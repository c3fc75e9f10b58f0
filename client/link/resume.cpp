#include "client/link/resume.hpp"

#include <algorithm>
#include <utility>

namespace earthwork::link {

using protocol::Code;
using protocol::Failure;
using std::chrono::milliseconds;

namespace {

/// What passes by itself: the network's faults and a server that ends or fails.
bool may_pass(Code code) {
  return code == Code::internal || code == Code::timeout || code == Code::shutting_down;
}

/// Trying again would be told the same.
bool is_final(const Closing& closing) {
  const Code code = closing.failure.code;
  if (code == Code::unknown_map || code == Code::bad_version) return true;
  return closing.cause == CloseCause::asked ||
         (closing.cause == CloseCause::refused && !may_pass(code));
}

}  // namespace

Resume::Resume(ResumeOptions options, std::uint64_t seed, Time now)
    : options_(std::move(options)),
      backoff_(seed),
      unanswered_(options_.last_id),
      away_since_(now) {}

std::string Resume::look(const protocol::View& view) {
  view_ = view;
  view_->have.reset();
  return protocol::write(*view_);
}

void Resume::take_welcome(const protocol::Welcome& welcome) {
  reached_ = true;
  options_.hello.key = welcome.key;
}

Resume::Entrance Resume::take_joined(const protocol::Joined& joined, Time now) {
  Entrance out{.joining = Joining::again, .lost = {}};
  if (!epoch_) out.joining = Joining::first;
  if (epoch_ && *epoch_ != joined.epoch) {
    out.joining = Joining::another_map;
    out.lost = give_up({.code = Code::unknown_map,
                        .detail = "map: " + joined.map + " is another map than before",
                        .field = "map"});
  }
  epoch_ = joined.epoch;
  joined_at_ = now;
  useful_ = !view_ && unanswered_.edits().empty();
  return out;
}

std::vector<std::string> Resume::opening(std::optional<protocol::Have> have) const {
  std::vector<std::string> out;
  if (view_) {
    protocol::View view = *view_;
    view.have = std::move(have);
    out.push_back(protocol::write(view));
  }
  for (const auto& [id, text] : unanswered_.edits()) out.push_back(text);
  return out;
}

std::optional<Answer> Resume::take(const protocol::ServerMessage& message) {
  std::optional<Answer> answer;
  if (const auto* applied = std::get_if<protocol::Applied>(&message)) {
    if (unanswered_.answer(applied->id))
      answer = {.id = applied->id, .fate = Fate::applied, .seq = applied->seq, .why = {}};
  } else if (const auto* rejected = std::get_if<protocol::Rejected>(&message)) {
    if (rejected->id && unanswered_.answer(*rejected->id))
      answer = {.id = *rejected->id, .fate = Fate::rejected, .seq = 0, .why = rejected->failure};
  } else if (const auto* bye = std::get_if<protocol::Bye>(&message)) {
    asked_delay_ = milliseconds(bye->retry_after_ms.value_or(0));
  }
  if (answer || std::holds_alternative<protocol::CaughtUp>(message)) useful_ = true;
  return answer;
}

std::optional<milliseconds> Resume::take_end(const Closing& closing, Time now) {
  const bool lasted = joined_at_ && now - *joined_at_ >= kProvenAfter;
  const bool useful = std::exchange(useful_, false) || lasted;
  const milliseconds asked = std::exchange(asked_delay_, milliseconds(0));
  joined_at_.reset();
  const bool nobody = closing.cause == CloseCause::unreachable && !reached_;
  if (is_final(closing) || (nobody && options_.first_try == FirstTry::must_reach)) return {};

  // A server that ends every connection with the same complaint is no use, however fast it answers.
  if (useful && may_pass(closing.failure.code)) {
    backoff_.restart();
    away_since_ = now;
  }
  const milliseconds delay = backoff_.next(asked);
  if (!options_.patience) return delay;
  const auto left = std::chrono::ceil<milliseconds>(away_since_ + *options_.patience - now);
  if (left.count() <= 0 || asked > left) return {};
  return std::min(delay, left);  // the last try is when the patience ends
}

std::vector<Answer> Resume::give_up(const Failure& why) {
  std::vector<Answer> out;
  for (const protocol::MessageId id : unanswered_.give_up())
    out.push_back({.id = id, .fate = Fate::lost, .seq = 0, .why = why});
  return out;
}

}  // namespace earthwork::link
