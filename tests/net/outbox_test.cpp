// What is written when: control before meshes, records as they fit.
#include "server/net/outbox.hpp"

#include <gtest/gtest.h>

#include <rapidcheck/gtest.h>

#include "protocol/limits.hpp"
#include "tests/net/wire_messages.hpp"

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

room::SharedText shared(std::string text) {
  return std::make_shared<const std::string>(std::move(text));
}

/// The next messages, at least one where anything waits.
std::vector<WireMessage> take(Outbox& outbox, std::size_t enough = 1) {
  std::string out;
  OutboxCounts counts;
  outbox.take(out, enough, counts);
  return wire_messages(out);
}

struct Read {
  std::vector<FrameEvent> events;
  std::vector<std::string> texts;
  std::vector<std::size_t> sizes;
};

void read(const std::vector<WireMessage>& messages, protocol::FrameReader& frames, Read& read) {
  for (const WireMessage& message : messages) {
    read.sizes.push_back(message.bytes.size());
    if (message.kind == Kind::text) {
      read.texts.push_back(message.bytes);
      continue;
    }
    const auto fed = frames.feed(std::as_bytes(std::span(message.bytes)), read.events);
    EXPECT_TRUE(fed) << fed.error().detail;
  }
}

/// All that waits, `enough` bytes at a time.
Read read_all(Outbox& outbox, std::size_t enough = 1) {
  Read all;
  protocol::FrameReader frames;
  for (auto some = take(outbox, enough); !some.empty(); some = take(outbox, enough))
    read(some, frames, all);
  return all;
}

TEST(Outbox, WritesAParcelInOrder) {
  Outbox outbox;
  outbox.put(room::Parcel{.group = protocol::GroupBegin{5, 9, 2},
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
  EXPECT_TRUE(outbox.has_parcel());
  EXPECT_TRUE(outbox.written().parcel);
  EXPECT_FALSE(outbox.has_parcel());
  EXPECT_FALSE(outbox.written().parcel);
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
}

TEST(Outbox, ControlGoesBeforeMeshesAlsoInTheMiddleOfAParcel) {
  Outbox outbox;
  outbox.put(room::Parcel{.group = protocol::GroupBegin{5, 9, 2}, .group_records = {record(1)}});
  ASSERT_EQ(take(outbox).at(0).kind, Kind::binary);
  outbox.say(protocol::Applied{1, 9});
  outbox.say(protocol::Applied{2, 10});
  const auto next = take(outbox, 10'000);
  ASSERT_EQ(next.size(), 4u);
  EXPECT_EQ(next[0].bytes, protocol::write(protocol::Applied{1, 9}));
  EXPECT_EQ(next[1].bytes, protocol::write(protocol::Applied{2, 10}));
  EXPECT_EQ(next[2].kind, Kind::binary);
  EXPECT_EQ(next[3].kind, Kind::binary);
}

TEST(Outbox, TalkGoesBehindControlAndBeforeMeshes) {
  Outbox outbox;
  outbox.put(room::Parcel{.group = protocol::GroupBegin{5, 9, 2}, .group_records = {record(1)}});
  ASSERT_EQ(take(outbox).at(0).kind, Kind::binary);
  outbox.put(room::Talk{{shared("one"), shared("two")}});
  EXPECT_EQ(take(outbox).at(0).bytes, "one");
  outbox.say(protocol::Applied{1, 9});
  const auto next = take(outbox, 10'000);
  ASSERT_EQ(next.size(), 4u);
  EXPECT_EQ(next[0].bytes, protocol::write(protocol::Applied{1, 9}));
  EXPECT_EQ(next[1].bytes, "two");
  EXPECT_EQ(next[2].kind, Kind::binary);
}

TEST(Outbox, OfSettingsTheLastGoBeforeTalkAndMeshes) {
  Outbox outbox;
  outbox.put(room::Parcel{.group = protocol::GroupBegin{5, 9, 2}, .group_records = {record(1)}});
  outbox.put(room::Talk{{shared("talk")}});
  outbox.put_settings(shared("older"));
  outbox.put_settings(shared("newer"));
  outbox.say(protocol::Applied{1, 9});
  const auto next = take(outbox, 10'000);
  ASSERT_EQ(next.size(), 6u);
  EXPECT_EQ(next[0].bytes, protocol::write(protocol::Applied{1, 9}));
  EXPECT_EQ(next[1].bytes, "newer");
  EXPECT_EQ(next[2].bytes, "talk");
  EXPECT_EQ(next[3].kind, Kind::binary);
}

TEST(Outbox, SettingsMayBeForgottenAndAreNotSaidAfterBye) {
  Outbox outbox;
  outbox.put_settings(shared("of a map that was left"));
  outbox.forget_settings();
  EXPECT_TRUE(take(outbox).empty());
  outbox.put_settings(shared("of one that ends"));
  outbox.end({.failure = {}, .retry_after_ms = {}});
  outbox.put_settings(shared("too late"));
  EXPECT_EQ(take(outbox, 10'000).size(), 1u);
}

TEST(Outbox, TalkIsThroughOnceItIsWritten) {
  Outbox outbox;
  EXPECT_FALSE(outbox.has_talk());
  outbox.put(room::Talk{{shared("one"), shared("two")}});
  ASSERT_EQ(take(outbox).size(), 1u);
  EXPECT_FALSE(outbox.written().talk);
  EXPECT_TRUE(outbox.has_talk());
  ASSERT_EQ(take(outbox).size(), 1u);
  EXPECT_TRUE(outbox.has_talk());
  EXPECT_TRUE(outbox.written().talk);
  EXPECT_FALSE(outbox.has_talk());
  outbox.put(room::Talk{});
  EXPECT_TRUE(outbox.written().talk);
}

TEST(Outbox, TakesNoMoreThanIsEnough) {
  Outbox outbox;
  room::Parcel parcel;
  for (int i = 0; i < 200; ++i) parcel.first_seen.push_back(record(i, 1000));
  outbox.put(std::move(parcel));
  constexpr std::size_t kEnough = 20'000;
  int takes = 0;
  for (;; ++takes) {
    std::string out;
    OutboxCounts counts;
    outbox.take(out, kEnough, counts);
    if (out.empty()) break;
    EXPECT_LT(out.size(), kEnough + protocol::kMaxFrameBytes + 4);
  }
  EXPECT_GT(takes, 10);
}

TEST(Outbox, CountsMessagesAndTheirBytes) {
  Outbox outbox;
  outbox.say(protocol::Applied{1, 9});
  outbox.put(room::Talk{{shared("four")}});
  outbox.put(room::Parcel{.group = protocol::GroupBegin{5, 9, 2},
                          .group_records = {record(1), record(2)},
                          .caught_up = protocol::CaughtUp{2, 9}});
  std::string out;
  OutboxCounts counts;
  outbox.take(out, 100'000, counts);
  EXPECT_EQ(counts.frames, 3u);
  EXPECT_EQ(counts.frame_bytes, 22 + (2 + 2 * record(1)->size()) + 10);
  EXPECT_EQ(counts.controls, 3u);
  EXPECT_EQ(counts.control_bytes, protocol::write(protocol::Applied{1, 9}).size() + 4 +
                                      protocol::write(protocol::CaughtUp{2, 9}).size());
}

TEST(Outbox, AnEmptyGroupIsItsBeginAndEnd) {
  Outbox outbox;
  outbox.put(room::Parcel{.group = protocol::GroupBegin{5, 9, 2}});
  EXPECT_EQ(take(outbox).size(), 1u);
  EXPECT_FALSE(outbox.written().parcel);
  EXPECT_EQ(take(outbox).size(), 1u);
  EXPECT_TRUE(outbox.written().parcel);
  EXPECT_TRUE(take(outbox).empty());
}

TEST(Outbox, CountsTheControlThatWaits) {
  Outbox outbox;
  EXPECT_EQ(outbox.control_bytes(), 0u);
  outbox.say(protocol::Applied{1, 9});
  const std::size_t size = outbox.control_bytes();
  EXPECT_GE(size, protocol::write(protocol::Applied{1, 9}).size());
  outbox.say(protocol::Applied{1, 9});
  EXPECT_EQ(outbox.control_bytes(), 2 * size);
  ASSERT_EQ(take(outbox).size(), 2u);
  EXPECT_EQ(outbox.control_bytes(), 0u);
}

TEST(Outbox, EndsWithBye) {
  Outbox outbox;
  outbox.put(room::Parcel{.group = protocol::GroupBegin{5, 9, 2}});
  outbox.put(room::Talk{{shared("four")}});
  outbox.say(protocol::Applied{1, 9});
  outbox.end({{protocol::Code::timeout, "why", {}}, {}});
  outbox.say(protocol::Applied{2, 9});
  outbox.put(room::Parcel{.group = protocol::GroupBegin{5, 9, 2}});
  outbox.put(room::Talk{{shared("five")}});
  EXPECT_FALSE(outbox.ended());
  const auto last = take(outbox, 10'000);
  ASSERT_EQ(last.size(), 2u);
  EXPECT_EQ(last[0].bytes, protocol::write(protocol::Applied{1, 9}));
  EXPECT_NE(last[1].bytes.find("\"bye\""), std::string::npos);
  EXPECT_TRUE(outbox.ended());
  EXPECT_TRUE(take(outbox).empty());
}

// However a parcel is cut into pieces, and whatever gets in between, it is the same parcel.
RC_GTEST_PROP(Outbox, KeepsOrderAndBoundaries, ()) {
  const auto sizes = *rc::gen::container<std::vector<int>>(rc::gen::inRange(3, 9000));
  const auto grouped = *rc::gen::inRange<std::size_t>(0, sizes.size() + 1);
  const auto enough = *rc::gen::inRange<std::size_t>(1, 60'000);
  room::Parcel parcel{.group = protocol::GroupBegin{5, 9, 2},
                      .caught_up = protocol::CaughtUp{2, 9}};
  for (std::size_t i = 0; i < sizes.size(); ++i)
    (i < grouped ? parcel.group_records : parcel.first_seen)
        .push_back(record(static_cast<std::int32_t>(i), sizes[i]));
  Outbox outbox;
  outbox.put(std::move(parcel));

  Read seen;
  protocol::FrameReader frames;
  int said = 0;
  for (auto some = take(outbox, enough); !some.empty(); some = take(outbox, enough)) {
    read(some, frames, seen);
    if (said < 20) outbox.say(protocol::Applied{++said, 9});
  }
  RC_ASSERT(seen.texts.size() == static_cast<std::size_t>(said) + 1);
  RC_ASSERT(seen.events.size() == sizes.size() + 2);
  RC_ASSERT(std::holds_alternative<protocol::GroupBegin>(seen.events.front()));
  RC_ASSERT(std::holds_alternative<protocol::GroupEnd>(seen.events[grouped + 1]));
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const std::size_t at = i < grouped ? i + 1 : i + 2;
    const auto& found = std::get<protocol::ChunkRecord>(seen.events[at]);
    RC_ASSERT(found.key.x == static_cast<std::int32_t>(i));
    RC_ASSERT(found.mesh.vertices.size() == static_cast<std::size_t>(sizes[i]));
  }
  for (const std::size_t size : seen.sizes) RC_ASSERT(size <= protocol::kMaxFrameBytes);
}

TEST(Outbox, TalksWithoutEndLeaveRoomForMeshes) {
  Outbox outbox;
  outbox.put(room::Parcel{.first_seen = {record(1, 3000), record(2, 3000), record(3, 3000)}});
  std::size_t talks = 0;
  for (int i = 0; i < 20; ++i) {
    outbox.put(room::Talk{{shared("{}"), shared("{}")}});
    for (bool heard = false; !heard;) {
      const auto messages = take(outbox);
      ASSERT_FALSE(messages.empty());
      for (const WireMessage& message : messages) talks += message.kind == Kind::text;
      heard = outbox.written().talk;
    }
    if (!outbox.has_parcel()) break;
  }
  EXPECT_FALSE(outbox.has_parcel());
  EXPECT_LT(talks, 20u);
}

}  // namespace
}  // namespace earthwork::net
