// Plays every transcript of this folder against the real server. With --update, or with
// EARTHWORK_UPDATE=1 in the environment, rewrites them with what is received now.
#include "tests/transcripts/transcript.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "tests/e2e/program.hpp"
#include "tests/transcripts/normal_form.hpp"
#include "tests/transcripts/player.hpp"

namespace earthwork::transcripts {
namespace {

bool update = std::getenv("EARTHWORK_UPDATE") != nullptr;

std::vector<std::filesystem::path> files() {
  std::vector<std::filesystem::path> out;
  const std::string folder = std::string(EARTHWORK_SOURCE_DIR) + "/tests/transcripts";
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".transcript") out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

class Transcripts : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(Transcripts, IsWhatTheServerSays) {
  const Transcript expected = parse(e2e::read_file(GetParam()));
  if (update) {
    std::ofstream(GetParam()) << write(record(expected));
    return;
  }
  EXPECT_EQ(play(expected), "");
}

INSTANTIATE_TEST_SUITE_P(, Transcripts, testing::ValuesIn(files()),
                         [](const auto& file) { return file.param.stem().string(); });

TEST(Transcript, IsWrittenAsItWasRead) {
  const std::string text =
      "# note\n\nmap demo {}\nshow meshes\nA> {\"a\":1}\nB>hex 00ff\nA< x\nB>close\nstop\n";
  const Transcript read = parse(text);
  ASSERT_EQ(read.lines.size(), 9u);
  EXPECT_EQ(read.lines[4].kind, Line::Kind::send);
  EXPECT_EQ(read.lines[4].client, 'A');
  EXPECT_EQ(read.lines[4].text, "{\"a\":1}");
  EXPECT_EQ(read.lines[5].text, "00ff");
  EXPECT_EQ(write(read), text);
}

TEST(Transcript, NamesALineThatIsNone) {
  try {
    parse("# note\nAB> {}\n");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "line 2 is no line of a transcript: AB> {}");
  }
}

TEST(Transcript, ExpandsWhatIsTooLongToWrite) {
  EXPECT_EQ(expand(R"({"path":$path(2),"x":$nest(3)}$spaces(2))"),
            R"({"path":[[0.5,0.5],[0.5,0.5]],"x":[[[]]]}  )");
}

TEST(NormalForm, NamesWhatDiffersFromRunToRun) {
  NormalForm normal;
  EXPECT_EQ(normal.text(
                R"({"users":[{"session":"00000000000000a1","author":"00000000000000a2"}],"id":1})"),
            R"({"users":[{"session":"$session1","author":"$author1"}],"id":1})");
  EXPECT_EQ(normal.text(R"({"seq":1,"time":1700000000123,"author":"00000000000000a3",)"
                        R"("hash":"00000000000000ff"})"),
            R"({"seq":1,"time":"$time","author":"$author2","hash":"00000000000000ff"})");
  EXPECT_EQ(normal.filled_in(R"({"key":"$author1"})"), R"({"key":"00000000000000a2"})");
}

TEST(NormalForm, ShowsPresenceOnDemand) {
  NormalForm normal;
  const std::string presence = R"({"type":"presence","left":["00000000000000a1"]})";
  EXPECT_EQ(normal.text(presence), std::nullopt);
  normal.show_presence = true;
  EXPECT_EQ(normal.text(presence), R"({"type":"presence","left":["$session1"]})");
}

// The harness itself: an answer that differs, one too few, one too many.
TEST(Player, TellsEveryKindOfDifference) {
  const std::string hello = R"(A> {"type":"hello","protocol":[1,1],"name":"ann","id":1})"
                            "\n";
  const std::string welcome =
      R"(A< {"type":"welcome","session":"$session1","key":"$key1","protocol":1,)"
      R"("limits":"$limits","id":1})"
      "\n";
  EXPECT_EQ(play(parse(hello + welcome)), "");
  EXPECT_TRUE(
      play(parse(hello + "A< {}\n")).starts_with("line 2 of the transcript\n  expected {}"));
  EXPECT_TRUE(play(parse(hello), std::chrono::seconds(60))
                  .starts_with("A received more: {\"type\":\"welcome\""));
}

}  // namespace
}  // namespace earthwork::transcripts

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  for (int i = 1; i < argc; ++i)
    if (std::string_view(argv[i]) == "--update") earthwork::transcripts::update = true;
  return RUN_ALL_TESTS();
}
