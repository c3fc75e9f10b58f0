// protocol/README.md is what clients are written from: its examples are held against the code.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "protocol/frame.hpp"
#include "protocol/limits.hpp"
#include "protocol/messages.hpp"
#include "protocol/recording.hpp"
#include "protocol/script.hpp"
#include "tests/protocol/readable.hpp"
#include "tests/protocol/record_packer.hpp"
#include "tests/protocol/samples.hpp"

namespace earthwork::protocol {
namespace {

std::string readme() {
  std::ifstream file(EARTHWORK_SOURCE_DIR "/protocol/README.md", std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The text of every fenced block, by the words after its opening fence.
std::map<std::string, std::string> blocks() {
  std::map<std::string, std::string> blocks;
  std::istringstream lines(readme());
  std::string open;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("```", 0) != 0) {
      if (!open.empty()) blocks[open] += line + "\n";
    } else {
      open = open.empty() ? line.substr(3) : "";
    }
  }
  return blocks;
}

std::vector<std::string> lines_of(const std::string& block) {
  std::vector<std::string> lines;
  std::istringstream stream(block);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::string bytes(const char* block) { return hex_dump(read_hex(blocks().at(block))); }

TEST(Readme, ShowsTheBytesOfRecords) {
  EXPECT_EQ(bytes("hex removed chunk"), hex_dump(encoded(removed_record())));
  EXPECT_EQ(bytes("hex square chunk"), hex_dump(encoded(record_of(square_mesh()))));
  const std::string hash = hex(mesh_hash(square_mesh()));
  EXPECT_NE(readme().find(hash), std::string::npos) << hash;
  const std::string term = hex(mesh_hash_term({2, -1, 3, 0}, mesh_hash(square_mesh())));
  EXPECT_NE(readme().find(term), std::string::npos) << term;
}

TEST(Readme, ShowsTheBytesOfADelta) {
  ChunkRecord cut = record_of(cut_square_mesh());
  cut.revision = 300;
  std::string delta;
  ASSERT_TRUE(encode_delta(encoded(record_of(ordered_square_mesh())), encoded(cut), delta));
  EXPECT_EQ(bytes("hex cut square delta"), hex_dump(delta));
  EXPECT_EQ(*apply_delta(ordered_square_mesh(), *decode_delta(bytes_of(delta))), cut);
  const std::string hash = hex(mesh_hash(cut_square_mesh()));
  EXPECT_NE(readme().find(hash), std::string::npos) << hash;
}

TEST(Readme, ShowsTheBytesOfAGroup) {
  const GroupBegin begin{.epoch = 0xfedcba9876543210, .seq = 258, .view = 3};
  EXPECT_EQ(bytes("hex group begin"), hex_dump(encode(begin)));
  EXPECT_EQ(bytes("hex group end"), hex_dump(encode(GroupEnd{258})));
  std::string message;
  RecordPacker packer([&](std::string packed) { message = std::move(packed); });
  packer.add(encoded(removed_record()));
  packer.finish();
  EXPECT_EQ(bytes("hex records"), hex_dump(message));
}

TEST(Readme, ShowsMessagesThatAreRead) {
  for (const std::string& line : lines_of(blocks().at("json client"))) {
    const auto message = parse_client_message(line);
    ASSERT_TRUE(message) << line;
    EXPECT_EQ(write(*message), line);
  }
  for (const std::string& line : lines_of(blocks().at("json server"))) {
    const auto message = parse_server_message(line);
    ASSERT_TRUE(message) << line;
    EXPECT_EQ(write(*message), line);
  }
}

TEST(Readme, ShowsAScriptThatIsRead) {
  const auto script = read_script(blocks().at("json script"));
  ASSERT_TRUE(script) << script.error().detail;
  EXPECT_TRUE(script->settings);
  EXPECT_GE(script->steps.size(), 3u);
}

TEST(Readme, ShowsARecordingAsItIsWritten) {
  const auto lines = lines_of(blocks().at("json recording"));
  ASSERT_EQ(lines.size(), 3u);
  const auto head = read_recording_head(lines[0]);
  ASSERT_TRUE(head) << head.error().detail;
  EXPECT_EQ(write(*head), lines[0]);
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const auto event = read_recorded_event(lines[i]);
    ASSERT_TRUE(event) << event.error().detail;
    EXPECT_EQ(event->seq, i);
    EXPECT_EQ(write(*event), lines[i]);
  }
}

TEST(Readme, ListsEveryLimitWithItsNumber) {
  const auto limits = nlohmann::json::parse(write(Welcome{}))["limits"];
  const std::string text = readme();
  for (const auto& [name, value] : limits.items()) {
    const auto number = static_cast<std::int64_t>(value.get<double>());
    const std::string row = "| `" + name + "` | " + std::to_string(number) + " |";
    EXPECT_NE(text.find(row), std::string::npos) << row;
  }
}

TEST(Readme, ListsEveryCode) {
  const std::string text = readme();
  for (int i = 0; i <= static_cast<int>(Code::internal); ++i) {
    const std::string row = "| `" + std::string(name(static_cast<Code>(i))) + "` |";
    EXPECT_NE(text.find(row), std::string::npos) << row;
  }
}

}  // namespace
}  // namespace earthwork::protocol
