/// Lines of a file of any length, one at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/limits.hpp"
#include "protocol/result.hpp"

namespace earthwork::app {

/// Holds one line, of at most protocol::kMaxControlBytes.
class LineReader {
 public:
  explicit LineReader(std::istream& in) : in_(in), buffer_(protocol::kMaxControlBytes + 2) {}

  /// The next line that is not blank, without its line break; nothing at the end. Valid until the
  /// next call. Fails with too_large for a line beyond the limit, and with storage_failed when the
  /// file cannot be read.
  [[nodiscard]] protocol::Result<std::optional<std::string_view>> next();
  /// The number of the line that was read last, from 1 on.
  [[nodiscard]] std::uint64_t number() const { return number_; }

 private:
  std::istream& in_;
  std::vector<char> buffer_;
  std::uint64_t number_ = 0;
};

}  // namespace earthwork::app
