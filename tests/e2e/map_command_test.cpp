// `earthwork-server map ...`: what each prints, how it ends, and what it leaves behind.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

#include "protocol/chunk_record.hpp"
#include "protocol/recording.hpp"
#include "server/journal/map_file.hpp"
#include "tests/e2e/program.hpp"
#include "tests/e2e/server_answers.hpp"
#include "tests/journal/logs.hpp"

namespace earthwork::e2e {
namespace {

using journal::ten_events;
using nlohmann::json;
using protocol::hex;

/// A data directory with a map named ten: ten events, each in a batch of its own, and a keyframe
/// after the eighth.
class MapCommand : public testing::Test {
 protected:
  MapCommand() {
    std::filesystem::create_directory(data_);
    auto made = journal::create_map_file(file("ten"), journal::small_identity());
    if (!made) throw std::runtime_error(made.error().detail);
    journal::fill(**made, ten_events(), {8});
  }

  Outcome map(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "map");
    arguments.insert(arguments.end(), {"--data", data_});
    return Program("earthwork-server", arguments).wait();
  }
  /// What it prints; it ends with 0 and says nothing else.
  json done(const std::vector<std::string>& arguments) const {
    const Outcome outcome = map(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << testing::PrintToString(arguments);
    EXPECT_EQ(outcome.err, "");
    return report(outcome);
  }
  std::string file(const std::string& name) const { return data_ + "/" + name + ".earthwork"; }
  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(data_))
      names.insert(entry.path().filename().string());
    return names;
  }
  /// Changes a byte of the map ten.
  void flip(std::size_t offset) const {
    std::fstream bytes(file("ten"), std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekg(static_cast<std::streamoff>(offset));
    const int before = bytes.get();
    bytes.seekp(static_cast<std::streamoff>(offset));
    bytes.put(static_cast<char>(before ^ 1));
  }

  Folder folder_;
  std::string data_ = folder_ / "data";
};

int lines(const std::string& text) {
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The place of each of a number's bytes as SQLite stores them, highest first.
std::vector<std::size_t> places_of(const std::string& bytes, std::uint64_t number) {
  std::string stored;
  for (int shift = 56; shift >= 0; shift -= 8) stored.push_back(static_cast<char>(number >> shift));
  std::vector<std::size_t> places;
  for (auto at = bytes.find(stored); at != std::string::npos; at = bytes.find(stored, at + 1))
    places.push_back(at);
  return places;
}

TEST_F(MapCommand, SaysWhatItCan) {
  const Outcome help = Program("earthwork-server", {"map", "--help"}).wait();
  EXPECT_EQ(help.exit_code, 0);
  for (const char* command :
       {"list", "info", "hash", "verify", "export", "import", "fork", "delete"}) {
    EXPECT_TRUE(contains(help.out, command));
    const Outcome one = Program("earthwork-server", {"map", command, "--help"}).wait();
    EXPECT_EQ(one.exit_code, 0);
    EXPECT_TRUE(contains(one.out, "--data"));
    EXPECT_TRUE(Program("earthwork-server", {"map", command, "--version"})
                    .wait()
                    .out.starts_with("earthwork-server 0."));
  }
}

TEST_F(MapCommand, RefusesWrongUseInOneLine) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{},
        {"dance"},
        {"info"},
        {"info", "nowhere"},
        {"info", "Ten"},
        {"info", "../ten"},
        {"hash", "ten", "--seq", "11"},
        {"hash", "ten", "--seq", "-1"},
        {"hash", "ten", "--seq", "last"},
        {"verify", "nowhere"},
        {"export", "ten"},
        {"export", "ten", folder_ / "out"},
        {"export", "nowhere", folder_ / "out.glb"},
        {"export", "ten", folder_ / "out.glb", "--layer", "0"},
        {"export", "ten", folder_ / "out.png", "--layer", "1"},
        {"export", "ten", folder_ / "out.jsonl", "--seq", "11"},
        {"export", "ten", folder_ / "out.glb", "--seq", "11"},
        {"import", "new", folder_ / "missing.jsonl"},
        {"import", "ten", file("ten")},
        {"import", "new!", file("ten")},
        {"fork", "ten", "ten"},
        {"fork", "nowhere", "new"},
        {"fork", "ten", "NEW"},
        {"fork", "ten", "new", "--seq", "11"},
        {"delete", "nowhere"}}) {
    const Outcome refused = map(arguments);
    EXPECT_EQ(refused.exit_code, 2) << testing::PrintToString(arguments);
    EXPECT_EQ(lines(refused.err), 1) << refused.err;
    EXPECT_EQ(refused.out, "");
  }
  EXPECT_EQ(files(), (std::set<std::string>{"lock", "ten.earthwork"}));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.glb"));
  const Outcome nowhere =
      Program("earthwork-server", {"map", "list", "--data", folder_ / "nowhere"}).wait();
  EXPECT_EQ(nowhere.exit_code, 2);
  EXPECT_TRUE(contains(nowhere.err, folder_ / "nowhere"));
}

TEST_F(MapCommand, FailsWhereNobodyTakesItsResults) {
  for (const std::string stdout_is : {">/dev/full", ">&-"}) {
    const Outcome outcome =
        Program("/bin/sh", {"-c", "exec \"$0\" map list --data \"$1\" " + stdout_is,
                            EARTHWORK_BIN_DIR "/earthwork-server", data_})
            .wait();
    EXPECT_EQ(outcome.exit_code, 1) << stdout_is;
    EXPECT_EQ(lines(outcome.err), 1) << outcome.err;
  }
  EXPECT_LT(read_file(data_ + "/lock").size(), 20u);  // a pid, and not the list
}

TEST_F(MapCommand, ListsEveryMap) {
  done({"fork", "ten", "five", "--seq", "5"});
  std::ofstream(file("broken")) << "not a map";
  const Outcome outcome = map({"list"});
  EXPECT_EQ(outcome.exit_code, 0);
  ASSERT_EQ(lines(outcome.out), 3);
  std::istringstream in(outcome.out);
  std::vector<json> maps(3);
  for (json& one : maps) in >> one;
  EXPECT_EQ(maps[0]["name"], "broken");
  EXPECT_EQ(maps[0]["seq"], nullptr);
  EXPECT_NE(maps[0]["state"], "sound");
  EXPECT_TRUE(contains(maps[0]["detail"], "broken.earthwork"));
  EXPECT_EQ(maps[1]["name"], "five");
  EXPECT_EQ(maps[1]["seq"], 5);
  EXPECT_EQ(maps[2]["state"], "sound");
  EXPECT_EQ(maps[2]["bytes"], std::filesystem::file_size(file("ten")));
}

TEST_F(MapCommand, PrintsHashesOfAnySeq) {
  EXPECT_EQ(done({"hash", "ten"}), (json{{"seq", 10}, {"hash", hex(ten_events()[9].hash)}}));
  EXPECT_EQ(done({"hash", "ten", "--seq", "3"}),
            (json{{"seq", 3}, {"hash", hex(ten_events()[2].hash)}}));
  EXPECT_EQ(done({"hash", "ten", "--seq", "0"})["hash"], "0000000000000000");
}

TEST_F(MapCommand, ShowsAndExportsWhatAServerDoes) {
  const json info = done({"info", "ten"});
  const std::string glb = folder_ / "ten.glb", png = folder_ / "ten.png";
  EXPECT_EQ(done({"export", "ten", glb})["hash"], hex(ten_events()[9].hash));
  EXPECT_EQ(done({"export", "ten", png})["bytes"], std::filesystem::file_size(png));
  EXPECT_EQ(info["events"], 10);
  EXPECT_EQ(info["keyframes"], json{8});
  EXPECT_EQ(info["file_bytes"], std::filesystem::file_size(file("ten")));
  EXPECT_EQ(10 * info["bytes_per_event"].get<double>(), info["file_bytes"].get<double>());
  EXPECT_EQ(info["created_ms"], journal::small_identity().created_ms);

  const ServerProgram server({.data = data_});
  EXPECT_EQ(get(server, "/api/maps/ten/export.glb"), read_file(glb));
  EXPECT_EQ(get(server, "/api/maps/ten/states.png"), read_file(png));
  json description = json::parse(get(server, "/api/maps/ten"));
  description.erase("users");
  description.update(figures(server, "ten"));
  for (const auto& [key, value] : description.items()) EXPECT_EQ(info.at(key), value) << key;
}

TEST_F(MapCommand, WaitsForNoServerThatHasTheDirectory) {
  const ServerProgram server({.data = data_});
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"list"}, {"verify", "ten"}, {"delete", "ten"}}) {
    const Outcome refused = map(arguments);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_EQ(lines(refused.err), 1);
    EXPECT_TRUE(contains(refused.err, "in use by process ")) << refused.err;
  }
  EXPECT_TRUE(std::filesystem::exists(file("ten")));
}

TEST_F(MapCommand, VerifiesASoundMap) {
  EXPECT_EQ(done({"verify", "ten"}), (json{{"name", "ten"},
                                           {"events", 10},
                                           {"hash", hex(ten_events()[9].hash)},
                                           {"keyframes", 1},
                                           {"sound", true},
                                           {"findings", json::array()}}));
}

TEST_F(MapCommand, BringsAMapFromOneDirectoryToAnother) {
  const std::string recording = folder_ / "ten.jsonl", again = folder_ / "again.jsonl";
  done({"export", "ten", recording});
  EXPECT_EQ(lines(read_file(recording)), 11);
  const json imported = done({"import", "new", recording});
  EXPECT_EQ(imported["seq"], 10);
  EXPECT_EQ(imported["hash"], hex(ten_events()[9].hash));
  const json info = done({"info", "new"});
  EXPECT_EQ(info["epoch"], imported["epoch"]);
  EXPECT_NE(info["epoch"], hex(journal::small_identity().epoch));
  EXPECT_EQ(info["keyframes"], json{10});
  EXPECT_EQ(done({"verify", "new"})["keyframes"], 1);

  done({"export", "new", again});
  const std::string before = read_file(recording), after = read_file(again);
  EXPECT_EQ(before.substr(before.find('\n')), after.substr(after.find('\n')));
  EXPECT_EQ(files(), (std::set<std::string>{"lock", "new.earthwork", "ten.earthwork"}));
}

TEST_F(MapCommand, ImportsIntoADirectoryThatIsNew) {
  done({"export", "ten", folder_ / "ten.jsonl"});
  const std::string fresh = folder_ / "a/b";
  EXPECT_EQ(
      Program("earthwork-server", {"map", "import", "ten", folder_ / "ten.jsonl", "--data", fresh})
          .wait()
          .exit_code,
      0);
  EXPECT_TRUE(std::filesystem::exists(fresh + "/ten.earthwork"));
}

TEST_F(MapCommand, LeavesNothingOfARecordingThatDoesNotAgree) {
  const std::string recording = folder_ / "ten.jsonl";
  done({"export", "ten", recording});
  std::string text = read_file(recording);
  text.replace(text.find(hex(ten_events()[8].hash)), 16, "00000000000000ab");
  std::ofstream(recording) << text;

  const auto before = files();
  const Outcome refused = map({"import", "new", recording});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_EQ(refused.out, "");
  EXPECT_EQ(lines(refused.err), 1);
  EXPECT_TRUE(contains(refused.err,
                       "ten.jsonl: line 10: seq 9: the stored hash is "
                       "00000000000000ab, executed it is "))
      << refused.err;
  EXPECT_EQ(files(), before);
}

TEST_F(MapCommand, ExportsInPlaceOfWhatWasThere) {
  const std::string out = folder_ / "ten.jsonl";
  std::ofstream(out) << "before";
  done({"export", "ten", out, "--seq", "4"});
  EXPECT_EQ(lines(read_file(out)), 5);
  const Outcome nowhere = map({"export", "ten", folder_ / "no/ten.glb"});
  EXPECT_EQ(nowhere.exit_code, 1);
  EXPECT_EQ(lines(nowhere.err), 1);
}

TEST_F(MapCommand, ForksAndDeletes) {
  const json forked = done({"fork", "ten", "five", "--seq", "5"});
  EXPECT_EQ(forked["seq"], 5);
  EXPECT_EQ(done({"hash", "five"})["hash"], hex(ten_events()[4].hash));
  EXPECT_EQ(done({"verify", "five"})["sound"], true);
  EXPECT_EQ(done({"info", "five"})["epoch"], forked["epoch"]);
  EXPECT_EQ(done({"fork", "ten", "all"})["seq"], 10);
  EXPECT_EQ(done({"verify", "all"})["keyframes"], 1);
  done({"delete", "ten"});
  EXPECT_EQ(files(), (std::set<std::string>{"all.earthwork", "five.earthwork", "lock"}));
}

TEST_F(MapCommand, NamesADamagedEventAndGivesWhatIsBeforeIt) {
  flip(read_file(file("ten")).find("\"x\":60.0") + 4);  // of event 7
  const Outcome verified = map({"verify", "ten"});
  EXPECT_EQ(verified.exit_code, 1);
  const json found = report(verified);
  EXPECT_EQ(found["sound"], false);
  EXPECT_EQ(found["events"], 6);
  EXPECT_EQ(found["hash"], hex(ten_events()[5].hash));
  ASSERT_EQ(found["findings"].size(), 1u);
  for (const char* part : {"ten.earthwork: ", "batches: ", "seq 7"})
    EXPECT_TRUE(contains(found["findings"][0], part)) << found["findings"][0];
  EXPECT_TRUE(contains(verified.err, "the log is good up to seq 6: map export ten OUT --seq 6"));
  EXPECT_TRUE(contains(verified.err, "still gives the map of seq 10, from keyframe 8 on"));

  for (const char* name : {"six.glb", "six.png", "six.jsonl"})
    EXPECT_EQ(done({"export", "ten", folder_ / name, "--seq", "6"})["hash"],
              hex(ten_events()[5].hash));
  EXPECT_EQ(done({"export", "ten", folder_ / "ten.glb"})["hash"], hex(ten_events()[9].hash));
  for (const char* name : {"seven.glb", "seven.jsonl"}) {
    const Outcome refused = map({"export", "ten", folder_ / name, "--seq", "7"});
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_TRUE(contains(refused.err, "seq 7")) << refused.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / name));
  }
}

TEST_F(MapCommand, SaysWhenADamagedKeyframeIsPassedOver) {
  const std::string bytes = read_file(file("ten"));
  bool keyframe_found = false;
  for (const std::size_t place : places_of(bytes, ten_events()[7].hash)) {
    flip(place);
    const json found = report(map({"verify", "ten"}));
    EXPECT_EQ(found["sound"], false);
    if (contains(found["findings"].at(0), "keyframes: seq 8")) {
      keyframe_found = true;
      EXPECT_EQ(found["events"], 10);
      const Outcome exported = map({"export", "ten", folder_ / "ten.glb"});
      EXPECT_EQ(exported.exit_code, 0);
      EXPECT_EQ(report(exported)["hash"], hex(ten_events()[9].hash));
      EXPECT_TRUE(contains(exported.err, "ten.earthwork: keyframes: seq 8")) << exported.err;
      EXPECT_TRUE(contains(exported.err, "executed again from 0")) << exported.err;
    }
    flip(place);
  }
  EXPECT_TRUE(keyframe_found);
}

// Every sum is right, as a flipped byte could not leave them.
TEST_F(MapCommand, NamesAnEventThatDidSomethingElse) {
  std::filesystem::remove(file("ten"));
  auto events = ten_events();
  auto made = journal::create_map_file(file("ten"), journal::small_identity());
  ASSERT_TRUE(made);
  events[4].hash ^= 1;
  ASSERT_TRUE((*made)->append(0, events));
  made->reset();

  const Outcome verified = map({"verify", "ten"});
  EXPECT_EQ(verified.exit_code, 1);
  EXPECT_EQ(report(verified)["findings"],
            json{"ten.earthwork: events: seq 5: the stored hash is " + hex(events[4].hash) +
                 ", executed it is " + hex(ten_events()[4].hash)});
  EXPECT_EQ(done({"hash", "ten", "--seq", "4"})["hash"], hex(events[3].hash));
  const Outcome refused = map({"hash", "ten"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_TRUE(contains(refused.err, "ten.earthwork: events: seq 5")) << refused.err;
}

TEST_F(MapCommand, KeepsWhatACrashHasLeft) {
  const auto made = journal::create_map_file(file("open"), journal::small_identity());
  ASSERT_TRUE(made);
  journal::fill(**made, ten_events(), {4});
  // As a kill leaves them: the file, and what SQLite has not moved into it.
  for (const char* part : {"", "-wal", "-tip"})
    std::filesystem::copy_file(file("open") + part, file("ten") + part,
                               std::filesystem::copy_options::overwrite_existing);
  ASSERT_GT(std::filesystem::file_size(file("ten") + "-wal"), 0u);
  EXPECT_EQ(done({"hash", "ten"})["hash"], hex(ten_events()[9].hash));
  EXPECT_EQ(done({"verify", "ten"})["events"], 10);
  EXPECT_EQ(done({"export", "ten", folder_ / "ten.glb"})["seq"], 10);
}

TEST_F(MapCommand, MissesTheEventsOfAWriteAheadFileThatIsGone) {
  const auto made = journal::create_map_file(file("open"), journal::small_identity());
  ASSERT_TRUE(made);
  journal::fill(**made, ten_events(), {});
  for (const char* part : {"", "-tip"})
    std::filesystem::copy_file(file("open") + part, file("ten") + part,
                               std::filesystem::copy_options::overwrite_existing);
  std::filesystem::remove(file("open"));
  const json listed = done({"list"});
  EXPECT_EQ(listed["state"], "damaged");
  EXPECT_EQ(listed["seq"], nullptr);
  const Outcome verified = map({"verify", "ten"});
  EXPECT_EQ(verified.exit_code, 1);
  EXPECT_LT(report(verified)["events"], 10);
  EXPECT_TRUE(contains(verified.err, "ten.earthwork")) << verified.err;
}

TEST_F(MapCommand, FindsAFlippedByteOrIsRightAllTheSame) {
  const std::string recording = folder_ / "ten.jsonl", again = folder_ / "again.jsonl";
  done({"export", "ten", recording});
  const std::size_t size = std::filesystem::file_size(file("ten"));
  int found = 0;
  for (std::size_t i = 0; i < 40; ++i) {
    const std::size_t place = i * size / 40 + i * 37 % 200;
    flip(place);
    const Outcome verified = map({"verify", "ten"});
    ASSERT_TRUE(verified.exit_code == 0 || verified.exit_code == 1)
        << place << ": " << verified.exit_code << " " << verified.err;
    found += verified.exit_code;
    if (verified.exit_code == 0) {
      done({"export", "ten", again});
      EXPECT_EQ(read_file(again), read_file(recording)) << place;
    }
    flip(place);
  }
  EXPECT_GT(found, 0);
  EXPECT_EQ(done({"verify", "ten"})["sound"], true);
}

}  // namespace
}  // namespace earthwork::e2e
