#include "client/bot/load_editor.hpp"

#include <algorithm>
#include <utility>

namespace earthwork::bot {
namespace {

using namespace std::chrono_literals;

constexpr auto kMostBehind = 1s;  // of a rate that could not be kept: the rest is not made up

protocol::Hello hello() {
  protocol::Hello out;
  out.name = "load editor";
  return out;
}

}  // namespace

LoadEditor::LoadEditor(link::EventLoop& loop, EditorPlan plan, LoadBoard& board)
    : plan_(std::move(plan)),
      board_(board),
      walk_(plan_.square, plan_.radius, plan_.seed),
      timer_(loop),
      link_(loop, {.server = plan_.server, .hello = hello(), .map = plan_.map},
            {.ready = [this] { ready_ = true; },
             .message = [this](const auto& message) { take(message); },
             .frame = {},
             .closed = [this](const auto& closing) { closed(closing); }}) {}

void LoadEditor::paint() {
  painting_ = true;
  due_ = LoadClock::now() + plan_.delay;
  if (plan_.edits_per_second)
    timer_.start(plan_.delay, [this] { send_all_due(); });
  else
    fill_window();
}

void LoadEditor::stop() {
  painting_ = false;
  timer_.cancel();
}

bool LoadEditor::may_send() const {
  const std::size_t window = plan_.edits_per_second ? kLoadRateWindow : kLoadWindow;
  return painting_ && !lost_ && in_flight_.size() < window && !link_.congested();
}

void LoadEditor::fill_window() {
  while (may_send()) send();
}

// What the window held back is sent when there is room again, in the pace of the rate.
void LoadEditor::send_all_due() {
  const std::chrono::duration<double> exact(1 / *plan_.edits_per_second);
  const auto interval = std::chrono::duration_cast<LoadClock::duration>(exact);
  const auto now = LoadClock::now();
  due_ = std::max(due_, now - kMostBehind);
  for (; due_ <= now && may_send(); due_ += interval) {
    counts_.lag.add(LoadClock::now() - due_);
    send();
  }
  constexpr auto kLookAgain = 1ms;  // while the window is full
  const auto wait = due_ > now ? due_ - now : LoadClock::duration(kLookAgain);
  if (painting_) timer_.start(wait, [this] { send_all_due(); });
}

void LoadEditor::send() {
  const protocol::MessageId id = ++last_id_;
  const auto now = LoadClock::now();
  ++counts_.edits;
  const auto sent = link_.send(protocol::EditMessage{.id = id, .edit = walk_.next()});
  if (!sent) return refused(sent.error());
  in_flight_.emplace(id, now);
}

void LoadEditor::take(const protocol::ServerMessage& message) {
  if (const auto* joined = std::get_if<protocol::Joined>(&message)) {
    board_.raise_last_seq(joined->seq);
  } else if (const auto* applied = std::get_if<protocol::Applied>(&message)) {
    const auto found = in_flight_.find(applied->id);
    if (found == in_flight_.end()) return;
    counts_.ack.add(LoadClock::now() - found->second);
    board_.sent.tell(applied->seq, found->second);
    board_.raise_last_seq(applied->seq);
    in_flight_.erase(found);
    ++counts_.acked;
  } else if (const auto* rejected = std::get_if<protocol::Rejected>(&message)) {
    if (rejected->id && in_flight_.erase(*rejected->id) > 0) refused(rejected->failure);
  }
  if (painting_ && !plan_.edits_per_second) fill_window();
}

void LoadEditor::refused(const protocol::Failure& why) {
  ++counts_.rejected;
  board_.tell("an edit is refused: " + std::string(name(why.code)) + ": " + why.detail);
}

void LoadEditor::closed(const link::Closing& closing) {
  if (closing.cause == link::CloseCause::asked) return;
  lost_ = true;
  stop();
  if (ready_)
    board_.tell("an editor: " + closing.failure.detail);
  else
    board_.fail(closing);
}

}  // namespace earthwork::bot
