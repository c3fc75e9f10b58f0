/// A value on the heap that copies share until one of them is about to change it: what makes a
/// chunk cheap to copy for somebody who reads it while its map goes on.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace earthwork::voxel {

/// Holds a T or nothing. Copying it costs one count. Different copies may be read, changed and let
/// go on different threads at the same time, whichever comes last; each single copy belongs to one
/// thread at a time.
template <class T>
class CopyOnWrite {
  struct Held {
    T value;
    std::atomic<std::uint32_t> copies{1};
  };

 public:
  /// Of memory, beside what the value holds elsewhere.
  static constexpr std::size_t kHeapBytes = sizeof(Held);

  /// Nothing.
  CopyOnWrite() = default;
  explicit CopyOnWrite(T value) : held_(new Held{std::move(value)}) {}
  CopyOnWrite(const CopyOnWrite& other) noexcept : held_(other.held_) {
    if (held_) held_->copies.fetch_add(1, std::memory_order_relaxed);
  }
  CopyOnWrite(CopyOnWrite&& other) noexcept : held_(std::exchange(other.held_, nullptr)) {}
  CopyOnWrite& operator=(CopyOnWrite other) noexcept {
    std::swap(held_, other.held_);
    return *this;
  }
  ~CopyOnWrite() { reset(); }

  void reset() noexcept {
    Held* held = std::exchange(held_, nullptr);
    if (held && held->copies.fetch_sub(1, std::memory_order_acq_rel) == 1) delete held;
  }

  explicit operator bool() const { return held_ != nullptr; }
  const T* operator->() const { return &held_->value; }
  const T& operator*() const { return held_->value; }

  /// The value, to be changed: no other copy sees it. Not for nothing. Valid until this copy is
  /// copied from.
  T& own() {
    // Acquired, so that what others read of the value before they let go of it came before.
    if (held_->copies.load(std::memory_order_acquire) != 1) *this = CopyOnWrite(T(held_->value));
    return held_->value;
  }

 private:
  Held* held_ = nullptr;
};

}  // namespace earthwork::voxel
