// Recordings become journals, whole or not at all, and come out of them again as they were.
#include "server/app/map_import.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "protocol/chunk_record.hpp"
#include "server/app/map_export.hpp"
#include "server/app/recorded_events.hpp"
#include "server/journal/audit.hpp"
#include "tests/e2e/program.hpp"
#include "tests/journal/logs.hpp"
#include "tests/journal/tampered_journal.hpp"

namespace earthwork::app {
namespace {

using journal::accepted;
using journal::Journal;
using journal::journal_of;
using journal::small_identity;
using journal::ten_events;
using protocol::Result;

constexpr std::int64_t kNow = 1800000000000;

Result<std::unique_ptr<Journal>> in_memory(const protocol::MapSettings& settings) {
  return journal::make_memory_journal({.settings = settings, .epoch = 7, .created_ms = kNow});
}

Result<Imported> imported(const std::string& text) {
  std::istringstream in(text);
  return import_recording(in, in_memory, kNow);
}

std::vector<std::string> lines_of(const std::vector<history::Event>& events) {
  std::vector<std::string> lines{
      write(protocol::RecordingHead{small_identity().settings, small_identity().epoch})};
  for (const auto& event : events) lines.push_back(write(to_recorded(event)));
  return lines;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// What importing ten events says when `change` was at their lines; the first event is on line 2.
std::string refusal(const std::function<void(std::vector<std::string>&)>& change) {
  auto lines = lines_of(ten_events());
  change(lines);
  const auto result = imported(joined(lines));
  return result ? "good" : result.error().detail;
}

std::string exported(Journal& journal, std::uint64_t seq) {
  const e2e::Folder folder;
  NewFile out(folder / "a.jsonl");
  EXPECT_TRUE(write_recording(journal, seq, out));
  EXPECT_TRUE(out.finish());
  return e2e::read_file(folder / "a.jsonl");
}

TEST(MapImport, KeepsEventsHashAndAgesOfWhatWasExported) {
  EXPECT_TRUE(rc::check([] {
    const auto events = accepted(*rc::gen::scale(0.5, journal::some_actions()));
    const auto original = journal_of(events);
    const auto again = imported(exported(*original, events.size()));
    RC_ASSERT(again.has_value());
    const auto before = restore(*original, {}, journal::Trust::strict);
    const auto after = restore(*again->journal, {}, journal::Trust::strict);
    RC_ASSERT(after->keyframe_seq == events.size());
    RC_ASSERT(after->hash == before->hash && again->hash == before->hash);
    RC_ASSERT(after->settings == before->settings);
    RC_ASSERT(after->ages == before->ages);
    RC_ASSERT(after->authors == before->authors);
    RC_ASSERT(audit(*again->journal)->sound());
    const auto page = again->journal->events(1, 1 << 24);
    RC_ASSERT(page->size() == events.size());
    for (std::size_t i = 0; i < events.size(); ++i)
      RC_ASSERT(to_recorded((*page)[i]) == to_recorded(events[i]));
  }));
}

TEST(MapImport, ProvesChangesOfLayersToo) {
  const auto rename = [](std::uint32_t layer) {
    return protocol::LayerChange{.layer = layer, .name = "roof", .color = {}, .wall = {}};
  };
  protocol::Edit roof = journal::disc(4, 4, 3);
  roof.layer = 1;
  auto events = accepted({journal::disc(4, 4, 3), protocol::LayerChange{}, roof, rename(1)});
  const auto made = imported(joined(lines_of(events)));
  ASSERT_TRUE(made) << made.error().detail;
  EXPECT_EQ(made->journal->identity().settings, small_identity().settings);
  EXPECT_EQ(restore(*made->journal, {}, journal::Trust::strict)->settings.layers.at(1).name,
            "roof");
  events[3].action = rename(2);
  EXPECT_EQ(imported(joined(lines_of(events))).error().detail,
            "line 5: layer: 2 of a map with 2 layers");
  events[3].action = rename(1);
  events[1].hash ^= 1;
  EXPECT_TRUE(imported(joined(lines_of(events)))
                  .error()
                  .detail.starts_with("line 3: seq 2: the stored hash is "));
}

TEST(MapImport, TakesTheSettingsAndAKeyframe) {
  const auto made = imported(joined(lines_of(ten_events())));
  ASSERT_TRUE(made) << made.error().detail;
  EXPECT_EQ(made->seq, 10u);
  EXPECT_EQ(made->journal->identity().settings, small_identity().settings);
  const auto keyframes = made->journal->keyframes();
  ASSERT_EQ(keyframes->size(), 1u);
  EXPECT_EQ(keyframes->at(0).seq, 10u);
  EXPECT_EQ(keyframes->at(0).time_ms, kNow);
}

TEST(MapImport, GoesOverManyBatches) {
  std::vector<protocol::Action> edits;
  for (std::size_t i = 0; i < 2 * kImportBatch + 5; ++i)
    edits.push_back(journal::disc(static_cast<double>(i % 50), 0, 1));
  const auto made = imported(joined(lines_of(accepted(edits))));
  ASSERT_TRUE(made) << made.error().detail;
  EXPECT_EQ(made->journal->last_seq(), 2 * kImportBatch + 5);
}

TEST(MapImport, TakesTheRecordingOfTheSpecification) {
  const std::string page = e2e::read_file(EARTHWORK_SOURCE_DIR "/protocol/README.md");
  const std::string fence = "```json recording\n";
  const auto start = page.find(fence) + fence.size();
  const auto made = imported(page.substr(start, page.find("```", start) - start));
  ASSERT_TRUE(made) << made.error().detail;
  EXPECT_EQ(made->seq, 2u);
}

TEST(MapImport, OfSettingsAloneIsAnEmptyMap) {
  const auto made = imported(R"({"map":{}})");
  ASSERT_TRUE(made) << made.error().detail;
  EXPECT_EQ(made->seq, 0u);
  EXPECT_EQ(made->hash, 0u);
}

TEST(MapImport, SkipsBlankLinesAndCountsThem) {
  auto lines = lines_of(ten_events());
  lines.insert(lines.begin(), "");
  lines.insert(lines.begin() + 3, " \t\r");
  EXPECT_TRUE(imported(joined(lines)));
  lines[4] = "nonsense";
  EXPECT_TRUE(imported(joined(lines)).error().detail.starts_with("line 5: not JSON"));
}

TEST(MapImport, NamesTheLineWhoseHashDiffers) {
  const std::string hash = protocol::hex(ten_events()[6].hash);
  EXPECT_EQ(
      refusal([&](auto& lines) { lines[7].replace(lines[7].find(hash), 16, "00000000000000ab"); }),
      "line 8: seq 7: the stored hash is 00000000000000ab, executed it is " + hash);
}

TEST(MapImport, NamesALineThatIsMissingOrTwice) {
  EXPECT_EQ(refusal([](auto& lines) { lines.erase(lines.begin() + 4); }),
            "line 5: seq 5: 4 comes next");
  EXPECT_EQ(refusal([](auto& lines) { lines.insert(lines.begin() + 4, lines[4]); }),
            "line 6: seq 4: 5 comes next");
  EXPECT_EQ(refusal([](auto& lines) { lines.erase(lines.begin()); }), "line 1: map: is missing");
}

TEST(MapImport, NamesALineWithoutAHash) {
  EXPECT_EQ(refusal([](auto& lines) {
              const auto at = lines[3].find(",\"hash\"");
              lines[3].erase(at, lines[3].size() - 1 - at);
            }),
            "line 4: hash: is missing");
}

TEST(MapImport, NamesAnIdThatDoesNotIncrease) {
  EXPECT_EQ(
      refusal([](auto& lines) { lines[4].replace(lines[4].find("\"id\":104"), 8, "\"id\":101"); }),
      "line 5: seq 4: id 101 is not above the last of author 00000000000000a1");
}

TEST(MapImport, HoldsEditsToTheirLimits) {
  EXPECT_EQ(refusal([](auto& lines) {
              lines[2].replace(lines[2].find("\"radius\":3.0"), 12, "\"radius\":512.5");
            }),
            "line 3: radius: 512.5 voxels is beyond the limit of 512");
  EXPECT_EQ(refusal([](auto& lines) { lines[2].insert(1, "\"layer\":1,"); }),
            "line 3: layer: 1 is outside 0 .. 0");
}

TEST(MapImport, BoundsALine) {
  const std::string padding(65536 - lines_of(ten_events())[2].size(), ' ');
  EXPECT_EQ(refusal([&](auto& lines) { lines[2] += padding; }), "good");
  EXPECT_EQ(refusal([&](auto& lines) { lines[2] += padding + " "; }),
            "line 3: 65537 bytes are beyond the limit of 65536");
  EXPECT_EQ(refusal([&](auto& lines) { lines[2] += std::string(10'000'000, ' '); }),
            "line 3: longer than the limit of 65536 bytes");
}

TEST(MapImport, RefusesWhatIsNoRecording) {
  EXPECT_EQ(imported("").error().detail, "the recording is empty");
  EXPECT_EQ(imported("\n\n").error().detail, "the recording is empty");
  EXPECT_EQ(imported("{\"map\":{\"chunk_resolution\":9}}").error().detail,
            "line 1: chunk_resolution: is not 8, 16, 32 or 64");
}

TEST(MapImport, SaysWhatTheDiskSays) {
  std::istringstream in(joined(lines_of(ten_events())));
  const auto refused = import_recording(
      in,
      [](const protocol::MapSettings& settings) -> Result<std::unique_ptr<Journal>> {
        return std::make_unique<journal::TamperedJournal>(std::move(*in_memory(settings)));
      },
      kNow);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, protocol::Code::read_only);
}

TEST(MapExport, WritesARecordingUpToASeq) {
  const auto journal = journal_of(ten_events(), {4});
  auto lines = lines_of(ten_events());
  EXPECT_EQ(exported(*journal, 10), joined(lines));
  lines.resize(7);
  EXPECT_EQ(exported(*journal, 6), joined(lines));
  lines.resize(1);
  EXPECT_EQ(exported(*journal, 0), joined(lines));
}

TEST(MapExport, OfADamagedLogEndsBeforeTheDamage) {
  journal::TamperedJournal journal(journal_of(ten_events()));
  journal.unreadable_event = 7;
  auto lines = lines_of(ten_events());
  lines.resize(7);
  EXPECT_EQ(exported(journal, 6), joined(lines));
  const e2e::Folder folder;
  NewFile out(folder / "a.jsonl");
  EXPECT_EQ(write_recording(journal, 7, out).error().code, protocol::Code::damaged);
}

}  // namespace
}  // namespace earthwork::app
