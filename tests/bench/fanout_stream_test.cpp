// What a viewer receives, counted without decoding it.
#include "tests/bench/fanout_stream.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <stdexcept>
#include <vector>

#include "protocol/frame.hpp"
#include "tests/protocol/record_packer.hpp"

namespace earthwork::bench {
namespace {

using Bytes = std::vector<unsigned char>;

/// As a server sends it: one unmasked WebSocket message.
void add_message(Bytes& out, unsigned char opcode, const std::string& payload) {
  out.push_back(static_cast<unsigned char>(0x80 | opcode));
  if (payload.size() < 126) {
    out.push_back(static_cast<unsigned char>(payload.size()));
  } else if (payload.size() < 65536) {
    out.insert(out.end(), {126, static_cast<unsigned char>(payload.size() >> 8),
                           static_cast<unsigned char>(payload.size() & 255)});
  } else {
    out.insert(out.end(), {127, 0, 0, 0, 0, 0, static_cast<unsigned char>(payload.size() >> 16),
                           static_cast<unsigned char>(payload.size() >> 8 & 255),
                           static_cast<unsigned char>(payload.size() & 255)});
  }
  out.insert(out.end(), payload.begin(), payload.end());
}

/// A full record of so many vertices.
std::string record(std::int32_t x, std::size_t vertices) {
  protocol::ChunkRecord record;
  record.key.x = x;
  for (std::size_t i = 0; i < vertices; ++i)
    record.mesh.vertices.push_back({.x = static_cast<std::int32_t>(i * 977 % 9001), .y = 5});
  std::string out;
  protocol::encode_record(record, out);
  return out;
}

/// A control message, a group of three records of which one runs across messages, an empty group,
/// a record on its own, and a ping.
Bytes sample(std::size_t& record_bytes) {
  Bytes out;
  add_message(out, 1, R"({"type":"caught_up","n":1,"seq":7})");
  protocol::RecordPacker packer([&](const std::string& message) { add_message(out, 2, message); });
  add_message(out, 2, protocol::encode(protocol::GroupBegin{.epoch = 1, .seq = 8, .view = 1}));
  record_bytes = 0;
  for (const std::size_t vertices : {3u, 20000u, 40u}) {
    const std::string bytes = record(1, vertices);
    record_bytes += bytes.size();
    packer.add(bytes);
  }
  packer.finish();
  add_message(out, 2, protocol::encode(protocol::GroupEnd{.seq = 8}));
  add_message(out, 2, protocol::encode(protocol::GroupBegin{.epoch = 1, .seq = 9, .view = 1}));
  add_message(out, 2, protocol::encode(protocol::GroupEnd{.seq = 9}));
  add_message(out, 9, "hm");
  const std::string alone = record(2, 5);
  record_bytes += alone.size();
  packer.add(alone);
  packer.finish();
  return out;
}

TEST(FanoutStream, CountsRecordsMessagesAndGroups) {
  std::size_t record_bytes = 0;
  const Bytes bytes = sample(record_bytes);
  StreamCounter counter;
  counter.feed(bytes);
  EXPECT_EQ(counter.counts().records, 4u);
  EXPECT_EQ(counter.counts().groups, 1u);  // the other one is empty
  EXPECT_EQ(counter.counts().texts, 1u);
  EXPECT_EQ(counter.counts().pings, 1u);
  EXPECT_EQ(counter.counts().bytes, record_bytes);
  EXPECT_GT(counter.counts().messages, 6u);
  EXPECT_TRUE(counter.caught_up());
}

TEST(FanoutStream, KnowsOfACatchUpWhateverComesAfterItInTheSameRead) {
  Bytes bytes;
  add_message(bytes, 1, R"({"type":"joined","seq":7})");
  StreamCounter counter;
  counter.feed(bytes);
  EXPECT_FALSE(counter.caught_up());
  bytes.clear();
  add_message(bytes, 1, R"({"type":"caught_up","n":1,"seq":7})");
  add_message(bytes, 1, R"({"type":"presence"})");
  counter.feed(bytes);
  EXPECT_TRUE(counter.caught_up());
}

RC_GTEST_PROP(FanoutStream, CountsTheSameInWhateverPiecesItComes, ()) {
  std::size_t record_bytes = 0;
  const Bytes bytes = sample(record_bytes);
  StreamCounter whole, pieces;
  whole.feed(bytes);
  for (std::size_t at = 0; at < bytes.size();) {
    const auto count = std::min(bytes.size() - at, *rc::gen::inRange<std::size_t>(1, 9000));
    pieces.feed(std::span(bytes).subspan(at, count));
    at += count;
  }
  RC_ASSERT(pieces.counts() == whole.counts());
}

TEST(FanoutStream, RefusesWhatNoServerSends) {
  for (const Bytes& bytes : {Bytes{0x02, 0x01}, Bytes{0x82, 0x81}, Bytes{0x82, 0x02, 1, 9}}) {
    StreamCounter counter;
    EXPECT_THROW(counter.feed(bytes), std::runtime_error);
  }
}

TEST(FanoutStream, CountsAMessageOfMoreThanSixtyFourKilobytes) {
  Bytes bytes;
  add_message(bytes, 1, std::string(70000, 'a'));
  add_message(bytes, 1, R"("type":"caught_up")");
  StreamCounter counter;
  counter.feed(bytes);
  EXPECT_EQ(counter.counts().texts, 2u);
  EXPECT_TRUE(counter.caught_up());
}

}  // namespace
}  // namespace earthwork::bench
