#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>

#include "protocol/byte_reader.hpp"
#include "protocol/byte_writer.hpp"

namespace earthwork::protocol {
namespace {

std::string varint(std::uint32_t value) {
  char bytes[kMaxVarintBytes];
  ByteWriter out(bytes);
  out.varint(value);
  return std::string(bytes, out.at());
}

ByteReader reader(std::string_view bytes) {
  return ByteReader(std::as_bytes(std::span(bytes.data(), bytes.size())));
}

TEST(Zigzag, PutsSmallMagnitudesFirst) {
  EXPECT_EQ(zigzag(0), 0u);
  EXPECT_EQ(zigzag(-1), 1u);
  EXPECT_EQ(zigzag(1), 2u);
  EXPECT_EQ(zigzag(-2), 3u);
  EXPECT_EQ(zigzag(INT32_MAX), 4294967294u);
  EXPECT_EQ(zigzag(INT32_MIN), 4294967295u);
}

RC_GTEST_PROP(Zigzag, ComesBack, (std::int32_t value)) {
  RC_ASSERT(unzigzag(zigzag(value)) == value);
}

TEST(ByteWriter, WritesLittleEndian) {
  char bytes[14];
  ByteWriter out(bytes);
  out.u16(0x0102);
  out.i32(-2);
  out.u64(0x0102030405060708);
  EXPECT_EQ(std::string(bytes, out.at()), std::string("\2\1\xfe\xff\xff\xff\10\7\6\5\4\3\2\1", 14));
}

TEST(Varint, TakesSevenBitsAByte) {
  EXPECT_EQ(varint(127), "\x7f");
  EXPECT_EQ(varint(128), "\x80\x01");
  EXPECT_EQ(varint(300), "\xac\x02");
  EXPECT_EQ(varint(UINT32_MAX), "\xff\xff\xff\xff\x0f");
}

RC_GTEST_PROP(Varint, ComesBack, ()) {
  const auto value = *rc::gen::arbitrary<std::uint32_t>() >> *rc::gen::inRange(0, 32);
  const std::string bytes = varint(value);
  ByteReader in = reader(bytes);
  RC_ASSERT(in.varint() == value);
  RC_ASSERT(!in.failed());
  RC_ASSERT(in.remaining() == 0u);
}

TEST(Varint, HasOneForm) {
  using std::string;
  for (const string& bytes :
       {string("\x80\x00", 2), string("\xff\x00", 2), string("\x80"), string(),
        string("\xff\xff\xff\xff\x10"), string("\xff\xff\xff\xff\xff\x01"),
        string("\x80\x80\x80\x80\x00", 5)}) {
    ByteReader in = reader(bytes);
    EXPECT_EQ(in.varint(), 0u);
    EXPECT_TRUE(in.failed());
    EXPECT_EQ(in.remaining(), 0u);
  }
}

TEST(ByteReader, GivesZerosPastTheEnd) {
  ByteReader in = reader("\x01\x02\x03");
  EXPECT_EQ(in.u16(), 0x0201);
  EXPECT_FALSE(in.failed());
  EXPECT_EQ(in.u16(), 0);
  EXPECT_TRUE(in.failed());
  EXPECT_EQ(in.u8(), 0) << "also what would have been there";
}

}  // namespace
}  // namespace earthwork::protocol
