/// A journal whose answers a test changes: what a damaged file, or a wrong one, would give.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/journal/journal.hpp"

namespace earthwork::journal {

struct TamperedJournal final : Journal {
  explicit TamperedJournal(std::unique_ptr<Journal> sound) : sound_(std::move(sound)) {}

  std::function<void(history::Event&)> change_event = [](history::Event&) {};
  std::function<void(ChunkState&)> change_chunk = [](ChunkState&) {};
  std::function<void(std::vector<ChunkState>&)> change_chunks = [](std::vector<ChunkState>&) {};
  std::function<void(std::vector<AuthorState>&)> change_authors = [](std::vector<AuthorState>&) {};
  std::function<void(std::vector<Keyframe>&)> change_keyframes = [](std::vector<Keyframe>&) {};
  std::optional<std::uint64_t> unreadable_event;       ///< Pages that hold it are damaged.
  std::optional<std::uint64_t> unreadable_keyframe;    ///< Its chunks are.
  std::optional<protocol::Failure> keyframes_failure;  ///< Of the list of keyframes.
  std::optional<protocol::Failure> authors_failure;
  std::uint64_t last = 0;  ///< Unless 0: the log ends here.

  const Identity& identity() const override { return sound_->identity(); }
  std::uint64_t last_seq() const override { return last ? last : sound_->last_seq(); }
  protocol::Result<void> append(std::uint64_t, std::span<const history::Event>) override {
    return protocol::fail(protocol::Code::read_only, "tampered with");
  }
  protocol::Result<std::vector<history::Event>> events(std::uint64_t from_seq,
                                                       std::size_t most_bytes) override {
    auto page = sound_->events(from_seq, most_bytes);
    for (history::Event& event : *page) {
      if (event.seq == unreadable_event)
        return protocol::fail(protocol::Code::damaged,
                              "a.earthwork: events: seq " + std::to_string(event.seq) + ": sum");
      change_event(event);
    }
    return page;
  }
  protocol::Result<void> put_chunks(std::span<const ChunkState> s) override {
    return sound_->put_chunks(s);
  }
  protocol::Result<void> put_authors(std::span<const AuthorState> a) override {
    return sound_->put_authors(a);
  }
  protocol::Result<void> put_keyframe(const Keyframe& k) override {
    return sound_->put_keyframe(k);
  }
  protocol::Result<bool> tidy(std::size_t most) override { return sound_->tidy(most); }
  protocol::Result<std::vector<Keyframe>> keyframes() override {
    if (keyframes_failure) return tl::unexpected<protocol::Failure>(*keyframes_failure);
    auto keyframes = sound_->keyframes();
    change_keyframes(*keyframes);
    return keyframes;
  }
  protocol::Result<void> chunks(
      std::uint64_t seq, const std::function<protocol::Result<void>(ChunkState)>& take) override {
    if (seq == unreadable_keyframe)
      return protocol::fail(protocol::Code::damaged,
                            "a.earthwork: chunks: seq " + std::to_string(seq) + ": sum");
    std::vector<ChunkState> states;
    auto told = sound_->chunks(seq, [&](ChunkState state) -> protocol::Result<void> {
      change_chunk(state);
      states.push_back(std::move(state));
      return {};
    });
    change_chunks(states);
    for (ChunkState& state : states)
      if (auto taken = take(std::move(state)); !taken) return taken;
    return told;
  }
  protocol::Result<std::vector<AuthorState>> authors() override {
    if (authors_failure) return tl::unexpected<protocol::Failure>(*authors_failure);
    auto authors = sound_->authors();
    change_authors(*authors);
    return authors;
  }

 private:
  std::unique_ptr<Journal> sound_;
};

}  // namespace earthwork::journal
