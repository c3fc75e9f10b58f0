#include "server/room/line.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace earthwork::room {
namespace {

// So many authors' ends are kept before it is looked which of them still matter.
constexpr std::size_t kManyEnds = 1024;

}  // namespace

Line::Head Line::head_of(const std::deque<Entry>& queue) {
  const Entry& first = queue.front();
  return {first.start, first.waiting.cost, first.number, first.waiting.command.author};
}

bool Line::push(Waiting waiting) {
  assert(waiting.cost >= 1);
  const std::size_t points = protocol::points(waiting.command.action);
  if (points_ + points > kMaxWaitingPoints) return false;

  const std::uint64_t author = waiting.command.author;
  std::uint64_t& end = ends_[author];
  const bool newcomer = end <= clock_ && !queues_.contains(author);
  const std::uint64_t start = std::max(clock_, end);
  end = start + waiting.cost;

  std::deque<Entry>& queue = queues_[author];
  queue.push_back({std::move(waiting), start, ++last_number_, newcomer});
  if (queue.size() == 1) heads_.insert(head_of(queue));
  ++size_;
  points_ += points;
  return true;
}

const Line::Waiting& Line::next() const {
  assert(has_next());
  return queues_.at(std::get<3>(*heads_.begin())).front().waiting;
}

void Line::put_aside() {
  assert(has_next());
  aside_.insert(heads_.extract(heads_.begin()));
}

Line::Waiting Line::pop() {
  assert(has_next());
  const auto queue = queues_.find(std::get<3>(*heads_.begin()));
  heads_.erase(heads_.begin());
  return take_first(queue);
}

Line::Waiting Line::take(std::uint64_t author) {
  const auto queue = queues_.find(author);
  assert(queue != queues_.end() && aside_.contains(head_of(queue->second)));
  aside_.erase(head_of(queue->second));
  return take_first(queue);
}

Line::Waiting Line::take_first(Queues::iterator queue) {
  Entry entry = std::move(queue->second.front());
  queue->second.pop_front();
  if (queue->second.empty())
    queues_.erase(queue);
  else
    heads_.insert(head_of(queue->second));

  --size_;
  points_ -= protocol::points(entry.waiting.command.action);
  clock_ = std::max(clock_, entry.start);
  // A newcomer starts where the clock stands: an endless row of them, each under a key of its own,
  // must not stop it, or whoever has an edit to come would wait for ever.
  if (entry.newcomer) ++clock_;
  if (empty())
    clear();
  else if (ends_.size() >= std::max(forget_at_, kManyEnds))
    forget_the_paid();
  return std::move(entry.waiting);
}

void Line::forget_the_paid() {
  std::erase_if(ends_, [this](const auto& end) { return end.second <= clock_; });
  forget_at_ = 2 * ends_.size();
}

// Nobody owes work to anybody when none waits: the clock starts anew.
void Line::clear() { *this = Line{}; }

std::int64_t Line::oldest_wait_ms(std::int64_t now_ms) const {
  std::int64_t oldest = now_ms;
  for (const auto& [author, queue] : queues_)
    oldest = std::min(oldest, queue.front().waiting.since_ms);
  return now_ms - oldest;
}

}  // namespace earthwork::room
