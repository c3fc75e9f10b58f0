/// The sums that stand beside what is stored: XXH3-64, seed 0, over little-endian bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace earthwork::journal {

/// Takes in one field after the other.
class StoredSum {
 public:
  StoredSum();
  ~StoredSum();
  StoredSum(const StoredSum&) = delete;
  StoredSum& operator=(const StoredSum&) = delete;

  StoredSum& add(std::uint64_t value);
  StoredSum& add(std::int64_t value) { return add(static_cast<std::uint64_t>(value)); }
  /// Its length, then itself.
  StoredSum& add(std::string_view text);
  StoredSum& add(std::span<const std::byte> bytes);

  [[nodiscard]] std::uint64_t value() const;

 private:
  struct State;
  State* state_;
};

}  // namespace earthwork::journal
