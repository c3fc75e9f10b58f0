// What is written when: control before meshes, records as they fit.
#include "server/net/outbox.hpp"

#include <gtest/gtest.h>

#include "protocol/limits.hpp"

namespace earthwork::net {
namespace {

using protocol::FrameEvent;

room::RecordBytes record(std::int32_t x, int vertices = 3) {
  protocol::ChunkRecord record;
  record.key = {0, x, 0, 0};
  record.revision = 1;
  for (int i = 0; i < vertices; ++i)
    record.mesh.vertices.push_back({i * 7 % 90000, i * 31 % 90000});
  record.mesh.triangles = {0, 1, 2};
  auto bytes = std::make_shared<std::string>();
  protocol::encode_record(record, *bytes);
  return bytes;
}

struct Read {
  std::vector<FrameEvent> events;
  std::vector<std::string> texts;
  std::vector<std::size_t> sizes;
  int ends = 0;
};

Read read_all(Outbox& outbox) {
  Read read;
  protocol::FrameReader frames;
  while (auto message = outbox.next()) {
    read.sizes.push_back(message->bytes.size());
    read.ends += message->ends_parcel;
    if (message->kind == Kind::text) {
      read.texts.push_back(message->bytes);
      continue;
    }
    const auto fed = frames.feed(std::as_bytes(std::span(message->bytes)), read.events);
    EXPECT_TRUE(fed) << fed.error().detail;
  }
  return read;
}

TEST(Outbox, WritesAParcelInOrder) {
  Outbox outbox;
  outbox.put({.group = protocol::GroupBegin{5, 9, 2},
              .group_records = {record(1), record(2)},
              .first_seen = {record(3)},
              .caught_up = protocol::CaughtUp{2, 9}});
  const Read read = read_all(outbox);
  ASSERT_EQ(read.events.size(), 5u);
  EXPECT_EQ(std::get<protocol::GroupBegin>(read.events[0]), (protocol::GroupBegin{5, 9, 2}));
  EXPECT_EQ(std::get<protocol::ChunkRecord>(read.events[1]).key.x, 1);
  EXPECT_EQ(std::get<protocol::ChunkRecord>(read.events[2]).key.x, 2);
  EXPECT_EQ(std::get<protocol::GroupEnd>(read.events[3]).seq, 9u);
  EXPECT_EQ(std::get<protocol::ChunkRecord>(read.events[4]).key.x, 3);
  ASSERT_EQ(read.texts.size(), 1u);
  EXPECT_EQ(read.texts[0], protocol::write(protocol::CaughtUp{2, 9}));
  EXPECT_EQ(read.ends, 1);
  EXPECT_FALSE(outbox.has_parcel());
}

TEST(Outbox, PacksManySmallRecordsAndSplitsLargeOnes) {
  Outbox outbox;
  room::Parcel parcel;
  for (int i = 0; i < 100; ++i) parcel.first_seen.push_back(record(i));
  parcel.first_seen.push_back(record(100, 20'000));
  outbox.put(std::move(parcel));
  const Read read = read_all(outbox);
  EXPECT_EQ(read.events.size(), 101u);
  EXPECT_LT(read.sizes.size(), 20u);
  for (const std::size_t size : read.sizes) EXPECT_LE(size, protocol::kMaxFrameBytes);
  EXPECT_EQ(read.ends, 1);
}

TEST(Outbox, ControlGoesBeforeMeshesAlsoInTheMiddleOfAParcel) {
  Outbox outbox;
  outbox.put({.group = protocol::GroupBegin{5, 9, 2}, .group_records = {record(1)}});
  ASSERT_EQ(outbox.next()->kind, Kind::binary);
  outbox.say(protocol::Applied{1, 9});
  outbox.say(protocol::Applied{2, 10});
  EXPECT_EQ(outbox.next()->bytes, protocol::write(protocol::Applied{1, 9}));
  EXPECT_EQ(outbox.next()->bytes, protocol::write(protocol::Applied{2, 10}));
  EXPECT_EQ(outbox.next()->kind, Kind::binary);
}

TEST(Outbox, AnEmptyGroupIsItsBeginAndEnd) {
  Outbox outbox;
  outbox.put({.group = protocol::GroupBegin{5, 9, 2}});
  EXPECT_FALSE(outbox.next()->ends_parcel);
  EXPECT_TRUE(outbox.next()->ends_parcel);
  EXPECT_FALSE(outbox.next());
}

TEST(Outbox, CountsTheControlThatWaits) {
  Outbox outbox;
  EXPECT_EQ(outbox.control_bytes(), 0u);
  outbox.say(protocol::Applied{1, 9});
  const std::size_t size = outbox.control_bytes();
  EXPECT_EQ(size, protocol::write(protocol::Applied{1, 9}).size());
  outbox.say(protocol::Applied{1, 9});
  EXPECT_EQ(outbox.control_bytes(), 2 * size);
  ASSERT_TRUE(outbox.next());
  EXPECT_EQ(outbox.control_bytes(), size);
}

TEST(Outbox, EndsWithBye) {
  Outbox outbox;
  outbox.put({.group = protocol::GroupBegin{5, 9, 2}});
  outbox.say(protocol::Applied{1, 9});
  outbox.end({{protocol::Code::timeout, "why", {}}, {}});
  outbox.say(protocol::Applied{2, 9});
  outbox.put({.group = protocol::GroupBegin{5, 9, 2}});
  EXPECT_FALSE(outbox.ended());
  EXPECT_EQ(outbox.next()->bytes, protocol::write(protocol::Applied{1, 9}));
  EXPECT_NE(outbox.next()->bytes.find("\"bye\""), std::string::npos);
  EXPECT_TRUE(outbox.ended());
  EXPECT_FALSE(outbox.next());
}

}  // namespace
}  // namespace earthwork::net
