#include "protocol/frame.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "protocol/limits.hpp"
#include "tests/protocol/arbitrary.hpp"
#include "tests/protocol/record_packer.hpp"
#include "tests/protocol/samples.hpp"

namespace earthwork::protocol {
namespace {

std::vector<std::string> packed(const std::vector<ChunkRecord>& records) {
  std::vector<std::string> messages;
  RecordPacker packer([&](std::string message) { messages.push_back(std::move(message)); });
  for (const ChunkRecord& record : records) packer.add(encoded(record));
  packer.finish();
  return messages;
}

/// A message of the record stream that holds `bytes`.
std::string piece(std::string_view bytes) { return std::string("\x01\x02") + std::string(bytes); }

/// Feeds the messages one after the other: "good", or "code: detail" of the first failure.
std::string fed(const std::vector<std::string>& messages, std::vector<FrameEvent>& events) {
  FrameReader reader;
  for (const std::string& message : messages) {
    const auto result = reader.feed(bytes_of(message), events);
    if (!result) return std::string(name(result.error().code)) + ": " + result.error().detail;
  }
  return "good";
}

std::string fed(const std::vector<std::string>& messages) {
  std::vector<FrameEvent> events;
  return fed(messages, events);
}

TEST(Frame, GivesBackAGroup) {
  const GroupBegin begin{.epoch = 0xfedcba9876543210, .seq = 12, .view = 3};
  std::vector<std::string> messages = packed({record_of(square_mesh()), removed_record()});
  ASSERT_EQ(messages.size(), 1u);
  std::vector<FrameEvent> events;
  EXPECT_EQ(fed({encode(begin), messages[0], encode(GroupEnd{12})}, events), "good");
  EXPECT_EQ(events, (std::vector<FrameEvent>{begin, record_of(square_mesh()), removed_record(),
                                             GroupEnd{12}}));
}

TEST(Frame, KnowsWhetherAGroupIsOpen) {
  FrameReader reader;
  std::vector<FrameEvent> events;
  EXPECT_FALSE(reader.in_group());
  ASSERT_TRUE(reader.feed(bytes_of(encode(GroupBegin{1, 2, 3})), events));
  EXPECT_TRUE(reader.in_group());
  ASSERT_TRUE(reader.feed(bytes_of(encode(GroupEnd{2})), events));
  EXPECT_FALSE(reader.in_group());
}

TEST(Frame, CarriesALargeRecordAcrossMessages) {
  const ChunkRecord large = record_of(band_mesh(2100));
  const auto messages = packed({large, removed_record()});
  ASSERT_EQ(messages.size(), 3u);
  EXPECT_EQ(messages[0].size(), 16384u);
  EXPECT_EQ(messages[1].size(), 16384u);
  std::vector<FrameEvent> events;
  EXPECT_EQ(fed(messages, events), "good");
  EXPECT_EQ(events, (std::vector<FrameEvent>{large, removed_record()}));
}

TEST(Frame, PacksNothingIntoNothing) { EXPECT_TRUE(packed({}).empty()); }

RC_GTEST_PROP(Frame, MayCutTheStreamAnywhere, ()) {
  std::vector<FrameEvent> expected;
  std::string stream;
  for (auto left = *rc::gen::inRange(1, 6); left > 0; --left) {
    const ChunkRecord record = *any_record(60);
    encode_record(record, stream);
    expected.emplace_back(record);
  }
  std::vector<std::string> messages;
  for (std::string_view rest = stream; !rest.empty();) {
    const auto size = *rc::gen::inRange<std::size_t>(1, std::min<std::size_t>(rest.size(), 99) + 1);
    messages.push_back(piece(rest.substr(0, size)));
    rest.remove_prefix(size);
  }
  std::vector<FrameEvent> events;
  RC_ASSERT(fed(messages, events) == "good");
  RC_ASSERT(events == expected);
}

RC_GTEST_PROP(Frame, IsPackedIntoFullMessages, ()) {
  std::vector<ChunkRecord> records;
  for (auto left = *rc::gen::inRange(0, 40); left > 0; --left) records.push_back(*any_record(900));
  std::vector<FrameEvent> events;
  const auto messages = packed(records);
  for (std::size_t i = 0; i < messages.size(); ++i) {
    RC_ASSERT(messages[i].size() <= kMaxFrameBytes);
    if (i + 1 < messages.size()) RC_ASSERT(messages[i].size() == kMaxFrameBytes);
  }
  RC_ASSERT(fed(messages, events) == "good");
  RC_ASSERT(events == std::vector<FrameEvent>(records.begin(), records.end()));
}

TEST(Frame, RefusesAnotherVersion) {
  std::string begin = encode(GroupBegin{1, 2, 3});
  begin[0] = 2;
  EXPECT_EQ(fed({begin}), "bad_version: version: 2 is not 1");
}

TEST(Frame, BoundsAMessage) {
  EXPECT_EQ(fed({""}), "bad_frame: message: is shorter than its two bytes of head");
  EXPECT_EQ(fed({"\x01"}), "bad_frame: message: is shorter than its two bytes of head");
  EXPECT_EQ(fed({std::string("\x01\x04")}), "bad_frame: kind: 4 is not 1, 2 or 3");
  EXPECT_EQ(fed({piece("")}), "bad_frame: records: are none");
  EXPECT_EQ(fed({encode(GroupBegin{}) + "x"}), "bad_frame: group begin: is not 22 bytes long");
  EXPECT_EQ(fed({encode(GroupBegin{}), encode(GroupEnd{}).substr(0, 9)}),
            "bad_frame: group end: is not 10 bytes long");
  const std::string large = encoded(record_of(band_mesh(2100)));
  EXPECT_EQ(fed({piece(large.substr(0, 16382))}), "good");
  EXPECT_EQ(fed({piece(large.substr(0, 16383))}),
            "bad_frame: message: 16385 bytes are beyond the limit of 16384");
}

TEST(Frame, BoundsARecordsLengthBeforeItsBytesCome) {
  EXPECT_EQ(fed({piece(std::string("\x00\x00\x10\x00", 4))}), "good") << "1 MiB is to follow";
  EXPECT_EQ(fed({piece(std::string("\x01\x00\x10\x00", 4))}),
            "bad_frame: length: 1048577 bytes of a record are outside 22 .. 1048576");
  EXPECT_EQ(fed({piece(std::string("\x15\x00", 2)), piece(std::string("\x00\x00", 2))}),
            "bad_frame: length: 21 bytes of a record are outside 22 .. 1048576");
}

TEST(Frame, KeepsGroupsAndRecordsApart) {
  const std::string begin = encode(GroupBegin{1, 2, 3}), end = encode(GroupEnd{2});
  const std::string record = encoded(removed_record());
  const std::string half = piece(record.substr(0, 20)), rest = piece(record.substr(20));
  EXPECT_EQ(fed({half, begin}), "bad_frame: group begin: comes inside a record");
  EXPECT_EQ(fed({begin, half, end}), "bad_frame: group end: comes inside a record");
  EXPECT_EQ(fed({begin, half, rest, end}), "good");
  EXPECT_EQ(fed({begin, begin}), "bad_frame: group begin: comes inside a group");
  EXPECT_EQ(fed({end}), "bad_frame: group end: comes outside a group");
  EXPECT_EQ(fed({begin, encode(GroupEnd{3})}),
            "bad_frame: group end: has another seq than its begin");
}

TEST(Frame, HandsOnWhatIsWrongWithARecord) {
  std::string record = encoded(removed_record());
  record[4] = 9;
  EXPECT_EQ(fed({piece(record)}), "bad_frame: kind: is not 1 or 2");
}

}  // namespace
}  // namespace earthwork::protocol
