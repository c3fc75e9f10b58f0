// Authors and colours, made from keys and session names.
#include "server/net/identity.hpp"

#include <gtest/gtest.h>
#include <xxhash.h>

#include <set>

namespace earthwork::net {
namespace {

// Computed by another implementation: Python's hashlib.blake2b(key, key=b"earthwork: the author of
// a key", digest_size=16), its first 8 bytes as a little-endian number.
TEST(Identity, AnAuthorIsTheSameInEveryBuild) {
  EXPECT_EQ(author_of("00112233445566778899aabbccddeeff"), 0x535b7739af3c392cu);
  EXPECT_EQ(author_of(""), 0xc00edd37d8ecff79u);
}

TEST(Identity, KeysThatDifferInADigitHaveAuthorsThatShareNothing) {
  std::string key(32, '0');
  const std::uint64_t first = author_of(key);
  for (char& digit : key) {
    digit = '1';
    const int different = __builtin_popcountll(author_of(key) ^ first);
    EXPECT_TRUE(8 < different && different < 56) << key << ": " << different;
    digit = '0';
  }
}

TEST(Identity, AnAuthorIsNoHashThatAnybodyElseMakes) {
  const std::string key = "00112233445566778899aabbccddeeff";
  EXPECT_NE(author_of(key), XXH3_64bits(key.data(), key.size()));
  // BLAKE2b-128 without a key, from hashlib too.
  EXPECT_NE(author_of(key), 0x291926f6f42199cfu);
}

TEST(Identity, ASessionKeepsItsColour) {
  std::set<std::string> colors;
  for (int i = 0; i < 200; ++i) {
    const std::string color = color_for(std::to_string(i));
    EXPECT_EQ(color, color_for(std::to_string(i)));
    EXPECT_EQ(color.size(), 7u);
    EXPECT_EQ(color[0], '#');
    colors.insert(color);
  }
  EXPECT_GT(colors.size(), 4u);
}

}  // namespace
}  // namespace earthwork::net
