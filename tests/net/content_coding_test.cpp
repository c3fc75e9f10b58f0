// Accept-Encoding, as browsers, scripts and others write it.
#include "server/net/content_coding.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <string>

namespace earthwork::net {
namespace {

TEST(ContentCoding, GzipIsTakenWhereItIsNamed) {
  for (const char* header : {"gzip",
                             "gzip, deflate, br",
                             "deflate,gzip",
                             "br;q=1.0, gzip;q=0.8, *;q=0.1",
                             "GZip",
                             "x-gzip",
                             "*",
                             "*;q=0.5",
                             "gzip;q=0.001",
                             "gzip;q=1",
                             "gzip;q=1.000",
                             "gzip;q=1.",
                             " gzip ; q=0.5 ",
                             "gzip ;Q=0.5",
                             "\tgzip\t",
                             "gzip;level=9;q=0.5",
                             ",,gzip,,",
                             "identity, gzip",
                             "identity;q=0.5, gzip;q=0.5",
                             "gzip;q=0.2, *;q=0",
                             "identity;q=0, gzip"})
    EXPECT_TRUE(prefers_gzip(header)) << header;
}

TEST(ContentCoding, WithoutAYesThePlainBytesAreSent) {
  for (const char* header : {"", " ", ",", "deflate, br", "identity", "gzipped", "gzip;q=0",
                             "gzip;q=0.0", "gzip;q=0.000", "gzip; q=0", "gzip;q=0, *;q=1", "*;q=0",
                             "br, *;q=0", "identity, gzip;q=0.5", "gzip;q=0.4, identity;q=0.5",
                             "gzip;q=0.5;q=1, identity", "\"gzip\""})
    EXPECT_FALSE(prefers_gzip(header)) << header;
}

TEST(ContentCoding, AWeightThatIsNoneIsANo) {
  for (const char* weight : {"", "x", "2", "1.001", "-1", "0.1234", "1e0", ".5", "0,5", "10", "0x1",
                             "0.5x", "00.5", "+1", "1.0000"})
    EXPECT_FALSE(prefers_gzip(std::string("gzip;q=") + weight)) << weight;
}

TEST(ContentCoding, AnyTextIsReadToItsEnd) {
  EXPECT_TRUE(rc::check([] {
    const auto text = *rc::gen::container<std::string>(
        rc::gen::element('g', 'z', 'i', 'p', ',', ';', '=', 'q', '0', '1', '.', '*', ' '));
    const bool taken = prefers_gzip(text);
    RC_ASSERT(prefers_gzip(text + ",gzip;q=1") || text.find("identity") != std::string::npos);
    RC_ASSERT(!prefers_gzip(text + ",gzip;q=0"));
    RC_ASSERT(prefers_gzip(text) == taken);
  }));
}

}  // namespace
}  // namespace earthwork::net
