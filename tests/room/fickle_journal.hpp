/// A journal in memory whose appends fail when the test says so.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "server/journal/memory_journal.hpp"

namespace earthwork::room {

class FickleJournal final : public journal::Journal {
 public:
  explicit FickleJournal(const journal::Identity& identity)
      : sound_(journal::make_memory_journal(identity)) {}

  std::optional<protocol::Failure> trouble;  ///< As long as it is set, appends fail with it.
  std::vector<std::size_t> batches;          ///< How many events each append had that succeeded.

  const journal::Identity& identity() const override { return sound_->identity(); }
  std::uint64_t last_seq() const override { return sound_->last_seq(); }
  protocol::Result<void> append(std::uint64_t expected_seq,
                                std::span<const history::Event> events) override {
    if (trouble) return tl::unexpected<protocol::Failure>(*trouble);
    batches.push_back(events.size());
    return sound_->append(expected_seq, events);
  }
  protocol::Result<std::vector<history::Event>> events(std::uint64_t from_seq,
                                                       std::size_t most_bytes) override {
    return sound_->events(from_seq, most_bytes);
  }
  protocol::Result<void> put_chunks(std::span<const journal::ChunkState> states) override {
    return sound_->put_chunks(states);
  }
  protocol::Result<void> put_authors(std::span<const journal::AuthorState> authors) override {
    return sound_->put_authors(authors);
  }
  protocol::Result<void> put_keyframe(const journal::Keyframe& keyframe) override {
    return sound_->put_keyframe(keyframe);
  }
  protocol::Result<bool> tidy(std::size_t most) override { return sound_->tidy(most); }
  protocol::Result<std::vector<journal::Keyframe>> keyframes() override {
    return sound_->keyframes();
  }
  protocol::Result<void> chunks(
      std::uint64_t seq,
      const std::function<protocol::Result<void>(journal::ChunkState)>& take) override {
    return sound_->chunks(seq, take);
  }
  protocol::Result<std::vector<journal::AuthorState>> authors() override {
    return sound_->authors();
  }

 private:
  std::unique_ptr<journal::Journal> sound_;
};

}  // namespace earthwork::room
