#include "server/net/identity.hpp"

#include <sodium.h>
#include <xxhash.h>

#include <array>

namespace earthwork::net {
namespace {

// Never to change: authors in stored maps were made with it.
constexpr std::string_view kHashKey = "earthwork: the author of a key";
static_assert(kHashKey.size() >= crypto_generichash_KEYBYTES_MIN &&
              kHashKey.size() <= crypto_generichash_KEYBYTES_MAX);

const unsigned char* bytes(std::string_view text) {
  return reinterpret_cast<const unsigned char*>(text.data());
}

// Far apart in hue, and dark enough for white text upon them.
constexpr std::array<const char*, 8> kColors{"#b3402a", "#8a6d00", "#3f7d20", "#00796b",
                                             "#1f6fb2", "#5e4fb3", "#a03a8c", "#6d4c41"};

}  // namespace

std::uint64_t author_of(std::string_view key) {
  std::array<unsigned char, crypto_generichash_BYTES_MIN> hash{};
  crypto_generichash(hash.data(), hash.size(), bytes(key), key.size(), bytes(kHashKey),
                     kHashKey.size());
  std::uint64_t author = 0;
  for (int i = 7; i >= 0; --i) author = author << 8 | hash[static_cast<std::size_t>(i)];
  return author;
}

std::string color_for(std::string_view session) {
  return kColors[XXH3_64bits(session.data(), session.size()) % kColors.size()];
}

}  // namespace earthwork::net
