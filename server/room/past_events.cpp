#include "server/room/past_events.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cassert>
#include <memory>
#include <string>
#include <utility>

#include "server/room/caught.hpp"

namespace earthwork::room {
namespace {

using protocol::Code;

std::size_t memory_bytes(const history::Event& event) {
  return sizeof event + protocol::points(event.action) * sizeof(protocol::MapPoint);
}

/// What came, as far as it is the events from `seq` on.
protocol::Result<std::vector<history::Event>> checked(
    protocol::Result<std::vector<history::Event>> page, std::uint64_t seq) {
  if (!page) return page;
  for (std::uint64_t next = seq; const history::Event& event : *page)
    if (event.seq != next++)
      return protocol::fail(Code::damaged, "events: seq " + std::to_string(next - 1) +
                                               " is missing, " + std::to_string(event.seq) +
                                               " is in its place");
  if (page->empty())
    return protocol::fail(Code::damaged, "events: seq " + std::to_string(seq) + " is missing");
  return page;
}

}  // namespace

PastEvents::PastEvents(journal::Clerk& clerk, std::function<Workplace()> workplace,
                       std::uint64_t last_seq)
    : clerk_(clerk), workplace_(std::move(workplace)), last_seq_(last_seq) {}

void PastEvents::add(std::span<const history::Event> events) {
  for (const history::Event& event : events) {
    assert(event.seq == last_seq_ + 1);
    last_seq_ = event.seq;
    window_bytes_ += memory_bytes(event);
    window_.push_back(event);
  }
  while (window_.size() > kWindowEvents || window_bytes_ > kWindowBytes) {
    window_bytes_ -= memory_bytes(window_.front());
    window_.pop_front();
  }
}

protocol::Result<const history::Event*> PastEvents::find(std::uint64_t seq) {
  assert(1 <= seq && seq <= last_seq_);
  if (const history::Event* event = at_hand(seq)) return event;
  if (!reading_ && !(unreadable_ && unreadable_->seq == seq)) read(seq);
  if (unreadable_ && unreadable_->seq == seq)
    return tl::unexpected(std::exchange(unreadable_, std::nullopt)->why);
  return at_hand(seq);
}

const history::Event* PastEvents::at_hand(std::uint64_t seq) {
  if (const std::uint64_t first = last_seq_ + 1 - window_.size(); seq >= first)
    return &window_[seq - first];
  const auto found = std::find_if(pages_.begin(), pages_.end(), [seq](const Page& page) {
    return page.front().seq <= seq && seq <= page.back().seq;
  });
  if (found == pages_.end()) return nullptr;
  pages_.splice(pages_.begin(), pages_, found);
  return &pages_.front()[seq - pages_.front().front().seq];
}

void PastEvents::read(std::uint64_t seq) {
  reading_ = seq;
  within_find_ = true;
  clerk_.post(journal::Urgency::idle,
              [this, seq, back = workplace_().back](journal::Journal& journal) {
                auto page = std::make_shared<protocol::Result<Page>>(
                    caught([&] { return journal.events(seq, kEventPageBytes); }));
                back([this, page] { arrived(std::move(*page)); });
              });
  within_find_ = false;
}

void PastEvents::arrived(protocol::Result<Page> page) {
  const std::uint64_t seq = *std::exchange(reading_, std::nullopt);
  if (page = checked(std::move(page), seq); page) {
    while (page->back().seq > last_seq_) page->pop_back();  // these are not said to be durable yet
    pages_.push_front(std::move(*page));
    if (pages_.size() > kKeptPages) pages_.pop_back();
  } else {
    spdlog::error("a follower's events from {} on cannot be read: {}", seq, page.error().detail);
    unreadable_ = Unreadable{seq, std::move(page.error())};
  }
  if (within_find_) return;
  came_();
  unreadable_.reset();  // who asks later has it tried again
}

}  // namespace earthwork::room
