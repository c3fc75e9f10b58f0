/// A shelf whose maps outlive their journals, in memory: opened, broken and mended at a test's
/// word.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/journal/memory_journal.hpp"
#include "server/journal/shelf.hpp"

namespace earthwork::room {

/// One thread only.
class KeptShelf final : public journal::Shelf {
 public:
  struct Map {
    std::shared_ptr<journal::Journal> journal;
    int opened = 0, open_now = 0;
    std::optional<protocol::Failure> broken{};      ///< What opening and removing it fails with.
    std::optional<protocol::Failure> unwritable{};  ///< What appending fails with.
  };
  std::map<std::string, Map, std::less<>> maps;
  std::optional<protocol::Failure> full{};  ///< What making a new one fails with.

  /// As if an earlier server had made it.
  Map& put(const std::string& name, const journal::Identity& identity) {
    return maps[name] = {.journal = journal::make_memory_journal(identity)};
  }

  [[nodiscard]] bool kept() const override { return true; }
  [[nodiscard]] protocol::Result<std::vector<std::string>> names() const override {
    std::vector<std::string> names;
    for (const auto& [name, map] : maps) names.push_back(name);
    return names;
  }
  [[nodiscard]] protocol::Result<std::unique_ptr<journal::Journal>> create(
      std::string_view name, const journal::Identity& identity) override {
    if (full) return tl::unexpected<protocol::Failure>(*full);
    if (maps.contains(name)) return protocol::fail(protocol::Code::map_exists, "it is there");
    put(std::string(name), identity);
    return open(name);
  }
  [[nodiscard]] protocol::Result<std::unique_ptr<journal::Journal>> open(
      std::string_view name) override {
    const auto found = maps.find(name);
    if (found == maps.end()) return protocol::fail(protocol::Code::unknown_map, "it is gone");
    ++found->second.opened;
    if (found->second.broken) return tl::unexpected<protocol::Failure>(*found->second.broken);
    return std::make_unique<Handle>(found->second);
  }
  [[nodiscard]] protocol::Result<void> remove(std::string_view name) override {
    const auto found = maps.find(name);
    if (found == maps.end()) return protocol::fail(protocol::Code::unknown_map, "it is gone");
    if (found->second.broken) return tl::unexpected<protocol::Failure>(*found->second.broken);
    if (found->second.open_now > 0) throw std::logic_error("removed while it is open");
    maps.erase(found);
    return {};
  }
  [[nodiscard]] protocol::Result<std::unique_ptr<journal::Clerk>> hire(
      std::unique_ptr<journal::Journal> journal) override {
    return std::make_unique<Clerk>(*this, std::move(journal));
  }

  /// From now on the work on journals waits, as it would for a slow disk, until it is let go on.
  void hold() { holding_ = true; }
  void go_on() {
    holding_ = false;
    for (const auto& work : std::exchange(held_, {})) work();
  }

 private:
  /// Works within the call, or when the shelf lets it.
  class Clerk final : public journal::Clerk {
   public:
    Clerk(KeptShelf& shelf, std::unique_ptr<journal::Journal> journal)
        : shelf_(shelf), journal_(std::move(journal)) {}
    ~Clerk() override { shelf_.go_on(); }
    Clerk(const Clerk&) = delete;
    Clerk& operator=(const Clerk&) = delete;
    void post(journal::Urgency, Task task) override {
      if (shelf_.holding_)
        shelf_.held_.push_back([this, task = std::move(task)] { task(*journal_); });
      else
        task(*journal_);
    }

   private:
    KeptShelf& shelf_;
    const std::unique_ptr<journal::Journal> journal_;
  };

  /// A journal that is open: what it does, it does to the map on the shelf.
  class Handle final : public journal::Journal {
   public:
    explicit Handle(Map& map) : map_(map), kept_(map.journal) {
      if (map.open_now++ > 0) throw std::logic_error("opened twice");
    }
    ~Handle() override { --map_.open_now; }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;

    [[nodiscard]] const journal::Identity& identity() const override { return kept_->identity(); }
    [[nodiscard]] std::uint64_t last_seq() const override { return kept_->last_seq(); }
    [[nodiscard]] protocol::Result<void> append(std::uint64_t expected_seq,
                                                std::span<const history::Event> events) override {
      if (map_.unwritable) return tl::unexpected<protocol::Failure>(*map_.unwritable);
      return kept_->append(expected_seq, events);
    }
    [[nodiscard]] protocol::Result<std::vector<history::Event>> events(
        std::uint64_t from_seq, std::size_t most_bytes) override {
      return kept_->events(from_seq, most_bytes);
    }
    [[nodiscard]] protocol::Result<void> put_chunks(
        std::span<const journal::ChunkState> states) override {
      return kept_->put_chunks(states);
    }
    [[nodiscard]] protocol::Result<void> put_authors(
        std::span<const journal::AuthorState> authors) override {
      return kept_->put_authors(authors);
    }
    [[nodiscard]] protocol::Result<void> put_keyframe(const journal::Keyframe& keyframe) override {
      return kept_->put_keyframe(keyframe);
    }
    [[nodiscard]] protocol::Result<bool> tidy(std::size_t most) override {
      return kept_->tidy(most);
    }
    [[nodiscard]] protocol::Result<std::vector<journal::Keyframe>> keyframes() override {
      return kept_->keyframes();
    }
    [[nodiscard]] protocol::Result<void> chunks(
        std::uint64_t seq,
        const std::function<protocol::Result<void>(journal::ChunkState)>& take) override {
      return kept_->chunks(seq, take);
    }
    [[nodiscard]] protocol::Result<std::vector<journal::AuthorState>> authors() override {
      return kept_->authors();
    }

   private:
    Map& map_;
    const std::shared_ptr<journal::Journal> kept_;
  };

  bool holding_ = false;
  std::vector<std::function<void()>> held_;
};

}  // namespace earthwork::room
