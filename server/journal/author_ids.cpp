#include "server/journal/author_ids.hpp"

#include "protocol/limits.hpp"

namespace earthwork::journal {
namespace {

using Applied = AuthorState::Applied;
constexpr auto kMost = static_cast<std::uint64_t>(protocol::kMaxInteger);

void append_step(std::uint64_t step, std::string& out) {
  for (; step >= 0x80; step >>= 7) out.push_back(static_cast<char>(step | 0x80));
  out.push_back(static_cast<char>(step));
}

/// A step above 0, added to `value`.
bool take_step(std::span<const std::byte>& in, std::uint64_t& value) {
  std::uint64_t step = 0;
  for (int shift = 0; shift < 56; shift += 7) {
    if (in.empty()) return false;
    const auto byte = std::to_integer<std::uint64_t>(in[0]);
    in = in.subspan(1);
    step |= (byte & 0x7F) << shift;
    if (byte >= 0x80) continue;
    value += step;
    return byte != 0 && value <= kMost;
  }
  return false;
}

}  // namespace

std::string encode_ids(std::span<const Applied> applied) {
  std::string bytes;
  Applied before;
  for (const Applied& one : applied) {
    append_step(static_cast<std::uint64_t>(one.id - before.id), bytes);
    append_step(one.seq - before.seq, bytes);
    before = one;
  }
  return bytes;
}

std::optional<std::vector<Applied>> decode_ids(std::span<const std::byte> bytes) {
  std::vector<Applied> applied;
  std::uint64_t id = 0, seq = 0;
  while (!bytes.empty()) {
    if (applied.size() == protocol::kMaxRememberedIds) return std::nullopt;
    if (!take_step(bytes, id) || !take_step(bytes, seq)) return std::nullopt;
    applied.push_back({.id = static_cast<std::int64_t>(id), .seq = seq});
  }
  return applied;
}

}  // namespace earthwork::journal
