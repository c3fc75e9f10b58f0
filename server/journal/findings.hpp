/// What an audit has found, in the words that people are told.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "protocol/result.hpp"
#include "server/journal/audit.hpp"
#include "server/journal/damage.hpp"

namespace earthwork::journal {

/// Keeps the first kMaxFindings and counts them all.
class Findings {
 public:
  /// Of a journal of this name.
  explicit Findings(std::string_view file) : file_(file) {}

  void add(protocol::Failure failure) {
    ++count_;
    if (list_.size() < kMaxFindings) list_.push_back(std::move(failure));
  }
  void add(const char* table, std::uint64_t seq, const std::string& sentence) {
    add(damage(file_, table, seq, sentence).value());
  }
  /// Adds a damage that the journal has met. Anything else is no finding and comes back.
  [[nodiscard]] protocol::Result<void> take(protocol::Failure failure) {
    if (failure.code != protocol::Code::damaged)
      return tl::unexpected<protocol::Failure>(std::move(failure));
    add(std::move(failure));
    return {};
  }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::vector<protocol::Failure> release() { return std::move(list_); }

 private:
  std::string file_;
  std::vector<protocol::Failure> list_;
  std::size_t count_ = 0;
};

}  // namespace earthwork::journal
