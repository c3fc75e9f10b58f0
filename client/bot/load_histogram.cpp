#include "client/bot/load_histogram.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace earthwork::bot {
namespace {

// Below 2 * kPerDoubling a bucket is one nanosecond wide; from there on each doubling has
// kPerDoubling buckets of twice the width of those before.
constexpr int kBits = 7;
constexpr std::uint64_t kPerDoubling = std::uint64_t{1} << kBits;
constexpr int kMaxBits = 42;
constexpr std::uint64_t kMaxTime_ns = (std::uint64_t{1} << kMaxBits) - 1;

std::size_t bucket_of(std::uint64_t time_ns) {
  const int shift = std::max(0, static_cast<int>(std::bit_width(time_ns)) - (kBits + 1));
  return static_cast<std::size_t>(shift) * kPerDoubling + (time_ns >> shift);
}

double middle_of(std::size_t bucket) {
  if (bucket < 2 * kPerDoubling) return static_cast<double>(bucket);
  const auto shift = static_cast<int>(bucket / kPerDoubling) - 1;
  const std::uint64_t least = (bucket % kPerDoubling + kPerDoubling) << shift;
  return static_cast<double>(least) + std::ldexp(0.5, shift);
}

}  // namespace

Histogram::Histogram() : buckets_(bucket_of(kMaxTime_ns) + 1) {}

void Histogram::add(std::chrono::nanoseconds time) {
  const auto time_ns = static_cast<std::uint64_t>(std::max<std::int64_t>(time.count(), 0));
  ++buckets_[bucket_of(std::min(time_ns, kMaxTime_ns))];
  ++count_;
}

void Histogram::add(const Histogram& other) {
  for (std::size_t i = 0; i < buckets_.size(); ++i) buckets_[i] += other.buckets_[i];
  count_ += other.count_;
}

std::optional<double> Histogram::percentile_ms(double percent) const {
  if (count_ == 0) return std::nullopt;
  const double share = percent / 100 * static_cast<double>(count_);
  const auto rank = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::ceil(share)));
  std::uint64_t below = 0;
  std::size_t bucket = 0;
  for (; bucket + 1 < buckets_.size(); ++bucket) {
    below += buckets_[bucket];
    if (below >= rank) break;
  }
  return middle_of(bucket) / 1e6;
}

}  // namespace earthwork::bot
