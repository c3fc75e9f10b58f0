#include "server/journal/stored_sum.hpp"

#include <bit>
#include <new>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace earthwork::journal {

static_assert(std::endian::native == std::endian::little, "summed bytes are memory's bytes");

struct StoredSum::State {
  XXH3_state_t xxh;
};

StoredSum::StoredSum() : state_(new State) { XXH3_64bits_reset(&state_->xxh); }
StoredSum::~StoredSum() { delete state_; }

StoredSum& StoredSum::add(std::uint64_t value) {
  XXH3_64bits_update(&state_->xxh, &value, sizeof value);
  return *this;
}

StoredSum& StoredSum::add(std::string_view text) {
  add(std::uint64_t{text.size()});
  XXH3_64bits_update(&state_->xxh, text.data(), text.size());
  return *this;
}

StoredSum& StoredSum::add(std::span<const std::byte> bytes) {
  return add(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

std::uint64_t StoredSum::value() const { return XXH3_64bits_digest(&state_->xxh); }

}  // namespace earthwork::journal
