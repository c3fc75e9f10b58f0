#include "server/net/identity.hpp"

#include <xxhash.h>

#include <array>

namespace earthwork::net {
namespace {

std::uint64_t hash(std::string_view text) { return XXH3_64bits(text.data(), text.size()); }

// Far apart in hue, and dark enough for white text upon them.
constexpr std::array<const char*, 8> kColors{"#b3402a", "#8a6d00", "#3f7d20", "#00796b",
                                             "#1f6fb2", "#5e4fb3", "#a03a8c", "#6d4c41"};

}  // namespace

std::uint64_t author_of(std::string_view key) { return hash(key); }

std::string color_for(std::string_view session) { return kColors[hash(session) % kColors.size()]; }

}  // namespace earthwork::net
