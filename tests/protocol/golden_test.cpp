// The bytes on the wire, kept in files: a change in any of them is a change of the protocol.
// EARTHWORK_UPDATE=1 writes the files anew.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "protocol/frame.hpp"
#include "protocol/messages.hpp"
#include "tests/protocol/readable.hpp"
#include "tests/protocol/samples.hpp"

namespace earthwork::protocol {
namespace {

std::string path_of(const std::string& name) {
  return EARTHWORK_SOURCE_DIR "/tests/protocol/golden/" + name;
}

std::string read_file(const std::string& name) {
  std::ifstream file(path_of(name), std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

void expect_golden(const std::string& name, const std::string& text) {
  if (const char* update = std::getenv("EARTHWORK_UPDATE"); update && *update == '1') {
    std::ofstream(path_of(name), std::ios::binary) << text;
    return;
  }
  EXPECT_EQ(read_file(name), text) << path_of(name) << " holds something else";
}

void expect_golden_record(const std::string& name, const ChunkRecord& record) {
  expect_golden(name, readable(record) + hex_dump(encoded(record)));
  const auto read = decode_record(bytes_of(read_hex(read_file(name))));
  ASSERT_TRUE(read) << name;
  EXPECT_EQ(*read, record) << name;
}

TEST(Golden, ChunkRecords) {
  expect_golden_record("empty.hex", record_of({}));
  expect_golden_record("square.hex", record_of(square_mesh()));
  expect_golden_record("bend.hex", record_of(bend_mesh()));
  expect_golden_record("band.hex", record_of(band_mesh(70)));
  expect_golden_record("removed.hex", removed_record());
}

TEST(Golden, Groups) {
  const GroupBegin begin{.epoch = 0xfedcba9876543210, .seq = 258, .view = 3};
  const GroupEnd end{.seq = 258};
  expect_golden("group_begin.hex", readable(begin) + hex_dump(encode(begin)));
  expect_golden("group_end.hex", readable(end) + hex_dump(encode(end)));
  FrameReader reader;
  std::vector<FrameEvent> events;
  ASSERT_TRUE(reader.feed(bytes_of(read_hex(read_file("group_begin.hex"))), events));
  ASSERT_TRUE(reader.feed(bytes_of(read_hex(read_file("group_end.hex"))), events));
  EXPECT_EQ(events, (std::vector<FrameEvent>{begin, end}));
}

template <class... Messages>
std::string lines(const Messages&... messages) {
  return ((write(messages) + "\n") + ...);
}

TEST(Golden, ClientMessages) {
  const Edit stamp{.layer = 0,
                   .stencil = StencilShape::circle,
                   .fill = true,
                   .radius = 3,
                   .path = {{10, -2.5}},
                   .is_path = false,
                   .stroke = {}};
  const Edit stroke{.layer = 2,
                    .stencil = StencilShape::square,
                    .fill = false,
                    .radius = 0.25,
                    .path = {{0, 0}, {1.5, 0}},
                    .is_path = true,
                    .stroke = 7};
  const std::string key = "00112233445566778899aabbccddeeff";
  expect_golden(
      "client.jsonl",
      lines(
          Hello{.name = "Jö", .color = "#aabbcc", .key = key, .id = 1},
          Join{.map = "demo", .seq = {}, .id = 2},
          View{.n = 1, .rect = MapRect{-16, -16, 48, 48}, .have = {}, .id = 3},
          View{.n = 2, .rect = {}, .have = Have{"fedcba9876543210", 258, {0, 0, 64, 64}}, .id = {}},
          EditMessage{4, stamp}, EditMessage{5, stroke},
          LayerMessage{6, {.layer = {}, .name = "roof", .color = "#aa3322", .wall = {{2, 2.5}}}},
          Undo{6}, Redo{7}, Cursor{.at = MapPoint{1, 2}, .brush = {}, .view = {}, .id = {}},
          Cursor{.at = MapPoint{1, 2},
                 .brush = Brush{StencilShape::square, 3, false, 1},
                 .view = MapRect{-8, 0, 8.5, 16},
                 .id = 8},
          Cursor{.at = {}, .brush = {}, .view = {}, .id = {}}, Events{.from_seq = 1, .id = 9},
          Ping{10}, Leave{11}));
}

TEST(Golden, ServerMessages) {
  const std::string session = "0123456789abcdef", key = "00112233445566778899aabbccddeeff";
  const User user{session, "Jö", "#aabbcc", "00112233445566ff"};
  const Presence presence{.all = true,
                          .users = {user},
                          .left = {"00000000000000ff"},
                          .cursors = {{session, MapPoint{1, 2}, Brush{}, MapRect{-8, 0, 8.5, 16}},
                                      {session, {}, {}, {}}}};
  const Edit stamp{.radius = 3, .path = {{10, -2.5}}, .stroke = {}};
  const Event event{.seq = 259,
                    .time_ms = 1'700'000'000'123,
                    .author = user.author,
                    .action = stamp,
                    .hash = "fedcba9876543210"};
  Event added = event;
  added.seq = 260;
  added.action = LayerChange{.layer = {}, .name = "roof", .color = {}, .wall = {}};
  MapSettings two_layers;
  two_layers.layers.push_back({.name = "roof"});
  const Failure far{Code::out_of_range, "radius: 600 voxels is beyond the limit of 512", "radius"};
  expect_golden("server.jsonl",
                lines(Welcome{.session = session, .key = key, .protocol = 1, .id = 1},
                      Joined{.map = "demo",
                             .settings = {},
                             .epoch = "fedcba9876543210",
                             .seq = 258,
                             .users = {user},
                             .id = 2},
                      Applied{4, 259}, Rejected{5, far}, CaughtUp{1, 259}, Done{9}, presence, event,
                      added, SettingsChanged{260, two_layers},
                      Bye{{Code::shutting_down, "the server ends", ""}, 1000}));
}

}  // namespace
}  // namespace earthwork::protocol
