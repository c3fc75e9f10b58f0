/// Packs chunk records into binary messages as a server might, from protocol/README.md alone.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "protocol/frame.hpp"
#include "protocol/limits.hpp"

namespace earthwork::protocol {

/// Messages of at most kMaxFrameBytes: many small records in one, one large record across several.
class RecordPacker {
 public:
  /// `emit` receives each finished message.
  explicit RecordPacker(std::function<void(std::string)> emit) : emit_(std::move(emit)) {}

  void add(std::string_view record) {
    while (!record.empty()) {
      if (message_.empty()) message_ = records_head();
      const std::size_t piece = std::min(record.size(), kMaxFrameBytes - message_.size());
      message_ += record.substr(0, piece);
      record.remove_prefix(piece);
      if (message_.size() == kMaxFrameBytes) finish();
    }
  }
  /// Emits what is left, if anything.
  void finish() {
    if (!message_.empty()) emit_(std::exchange(message_, {}));
  }

 private:
  std::function<void(std::string)> emit_;
  std::string message_;
};

}  // namespace earthwork::protocol
