#include "server/room/event_feed.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "protocol/chunk_record.hpp"

namespace earthwork::room {
namespace {

// Of the texts that were written so much is kept for the next follower. Those who follow live are
// told the same within one turn; who reads the past rarely meets another at the same place.
constexpr std::size_t kKeptBytes = std::size_t{1} << 20;

/// That the events end before `seq`. What is wrong inside the server is for its own log.
SharedText refusal(protocol::Code code, std::uint64_t seq) {
  return std::make_shared<const std::string>(protocol::write(protocol::Rejected{
      .id = {},
      .failure = {code, "from_seq: the events from " + std::to_string(seq) + " on cannot be read",
                  "from_seq"}}));
}

}  // namespace

protocol::Event to_protocol(const history::Event& event) {
  return {.seq = event.seq,
          .time_ms = event.time_ms,
          .author = protocol::hex(event.author),
          .action = event.action,
          .hash = protocol::hex(event.hash)};
}

void EventFeed::leave(ViewerId id) {
  next_.erase(id);
  if (!next_.empty()) return;
  texts_.clear();
  texts_bytes_ = 0;
}

std::vector<ViewerId> EventFeed::followers() const {
  std::vector<ViewerId> ids;
  ids.reserve(next_.size());
  const auto first = next_.upper_bound(last_reader_);
  for (auto place = first; place != next_.end(); ++place) ids.push_back(place->first);
  for (auto place = next_.begin(); place != first; ++place) ids.push_back(place->first);
  return ids;
}

void EventFeed::tell(ViewerId id, PastEvents& events, std::size_t bytes,
                     std::vector<SharedText>& out) {
  const auto found = next_.find(id);
  if (found == next_.end()) return;
  std::uint64_t& next = found->second;
  for (; next <= events.last_seq(); ++next) {
    const auto event = events.find(next);
    if (!event) {
      out.push_back(refusal(event.error().code, next));
      return leave(id);
    }
    if (!*event) {
      if (events.reading() == next) last_reader_ = id;
      return;
    }
    SharedText text = text_of(**event);
    if (text->size() > bytes && !out.empty()) return;
    bytes -= std::min(bytes, text->size());
    out.push_back(std::move(text));
  }
}

SharedText EventFeed::text_of(const history::Event& event) {
  if (const auto found = texts_.find(event.seq); found != texts_.end()) return found->second;
  auto text = std::make_shared<const std::string>(protocol::write(to_protocol(event)));
  texts_.emplace(event.seq, text);
  texts_bytes_ += text->size();
  for (; texts_bytes_ > kKeptBytes; texts_.erase(texts_.begin()))
    texts_bytes_ -= texts_.begin()->second->size();
  return text;
}

}  // namespace earthwork::room
