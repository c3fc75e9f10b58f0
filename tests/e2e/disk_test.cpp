// Disks as they are: full, and with bytes that are not what was written.
#include <gtest/gtest.h>
#include <sys/mount.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <string>
#include <thread>

#include "client/link/http_client.hpp"
#include "tests/e2e/scripts.hpp"
#include "tests/e2e/server_answers.hpp"

namespace earthwork::e2e {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using namespace std::chrono_literals;

/// A disk of `kilobytes`, mounted as long as it lives; it takes a right that not everybody has.
class SmallDisk {
 public:
  explicit SmallDisk(int kilobytes) : path_(folder_ / "disk") {
    fs::create_directory(path_);
    const std::string size = "size=" + std::to_string(kilobytes) + "k";
    mounted_ = ::mount("tmpfs", path_.c_str(), "tmpfs", 0, size.c_str()) == 0;
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  ~SmallDisk() {
    if (mounted_) ::umount2(path_.c_str(), MNT_DETACH);
  }
  [[nodiscard]] bool mounted() const { return mounted_; }
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  /// Whether it could be done.
  bool make_read_only(bool read_only) {
    const unsigned long flags = MS_REMOUNT | (read_only ? MS_RDONLY : 0);
    return ::mount("tmpfs", path_.c_str(), "tmpfs", flags, nullptr) == 0;
  }

 private:
  Folder folder_;
  const std::string path_;
  bool mounted_ = false;
};

class Disk : public testing::Test {
 protected:
  Outcome paint(const ServerProgram& server, const std::string& map, int count, unsigned seed) {
    const std::string script = folder_ / "script.jsonl";
    std::ofstream(script) << circles(count, 200, seed);
    return bot({"run", script, "--server", server.url(), "--map", map, "--create"});
  }
  /// One edit more is taken, after a minute at the latest.
  bool paints_in_the_end(const ServerProgram& server, const std::string& map) {
    const auto give_up = std::chrono::steady_clock::now() + 60s;
    while (paint(server, map, 1, 2).exit_code != 0) {
      if (std::chrono::steady_clock::now() > give_up) return false;
      std::this_thread::sleep_for(100ms);
    }
    return true;
  }
  static Outcome verify(const std::string& data, const std::string& map) {
    return Program("earthwork-server", {"map", "verify", map, "--data", data}).wait();
  }

  Folder folder_;
};

TEST_F(Disk, ThatIsFullRefusesEditsIsReadAndTakesThemAgain) {
  const SmallDisk disk(3000);
  if (!disk.mounted()) GTEST_SKIP() << "mounting is not allowed here";
  std::ofstream(disk / "ballast") << std::string(2'000'000, 'x');
  std::uint64_t acked = 0;
  std::string hash;
  {
    const ServerProgram server({.data = disk / "data"});
    const Outcome filling = paint(server, "m", 6000, 1);
    EXPECT_EQ(filling.exit_code, 1) << "all of it found room";
    EXPECT_NE(filling.err.find("disk_full"), std::string::npos) << filling.err.substr(0, 500);
    acked = report(filling)["acked"];
    EXPECT_GT(acked, 0u);
    EXPECT_GT(report(filling)["rejected"], 0);

    EXPECT_EQ(figures(server, "m")["seq"], acked);
    const Outcome watched = bot({"watch", "--server", server.url(), "--map", "m"});
    EXPECT_EQ(watched.exit_code, 0) << watched.err;
    EXPECT_EQ(report(watched)["mesh_hash"], figures(server, "m")["mesh_hash"]);

    fs::remove(disk / "ballast");
    ASSERT_TRUE(paints_in_the_end(server, "m"));
    EXPECT_EQ(paint(server, "m", 100, 3).exit_code, 0);
    acked += 101;
    EXPECT_EQ(figures(server, "m")["seq"], acked);
    hash = figures(server, "m")["hash"];
  }
  const Outcome verified = verify(disk / "data", "m");
  EXPECT_EQ(verified.exit_code, 0) << verified.err;
  EXPECT_EQ(report(verified)["events"], acked);
  EXPECT_EQ(report(verified)["hash"], hash);
}

TEST_F(Disk, ThatMayOnlyBeReadIsReadAndTakesEditsAgainAfterwards) {
  SmallDisk disk(3000);
  if (!disk.mounted()) GTEST_SKIP() << "mounting is not allowed here";
  const std::string data = disk / "data";
  {
    const ServerProgram server({.data = data});
    ASSERT_EQ(paint(server, "m", 50, 8).exit_code, 0);
  }
  ASSERT_TRUE(disk.make_read_only(true));
  EXPECT_EQ(verify(data, "m").exit_code, 0) << verify(data, "m").err;

  const ServerProgram server({.data = data});
  EXPECT_EQ(figures(server, "m")["seq"], 50);
  const Outcome refused = paint(server, "m", 3, 9);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("read_only"), std::string::npos) << refused.err;
  EXPECT_EQ(figures(server, "m")["seq"], 50);

  ASSERT_TRUE(disk.make_read_only(false));
  EXPECT_TRUE(paints_in_the_end(server, "m"));
  EXPECT_EQ(figures(server, "m")["seq"], 51);
}

TEST_F(Disk, ThatChangedAByteIsFoundOutOrDidNoHarm) {
  const std::string data = folder_ / "data";
  json whole;
  {
    const ServerProgram server({.data = data});
    ASSERT_EQ(paint(server, "m", 400, 4).exit_code, 0);
    whole = json::parse(get(server, "/api/maps/m"));
  }
  const std::string file = data + "/m.earthwork";
  const std::string sound = read_file(file);
  std::mt19937 random(5);
  int found = 0;
  for (int i = 0; i < 50; ++i) {
    std::string flipped = sound;
    const auto place = std::uniform_int_distribution<std::size_t>(0, sound.size() - 1)(random);
    flipped[place] = static_cast<char>(flipped[place] ^ (1 << (i % 8)));
    std::ofstream(file, std::ios::binary) << flipped;
    const Outcome outcome = verify(data, "m");
    if (outcome.exit_code != 0) {
      ++found;
      EXPECT_TRUE(outcome.exit_code == 1 || outcome.exit_code == 2) << place;
      EXPECT_NE((outcome.out + outcome.err).find("m.earthwork"), std::string::npos)
          << place << ": " << outcome.err;
      continue;
    }
    EXPECT_EQ(report(outcome)["hash"], whole["hash"]) << place;
    EXPECT_EQ(report(outcome)["events"], whole["seq"]) << place;
  }
  EXPECT_GT(found, 25);  // most bytes of the file mean something
}

TEST_F(Disk, ThatSpoiledOneMapLeavesTheOthersServed) {
  const std::string data = folder_ / "data";
  {
    const ServerProgram server({.data = data});
    for (const char* map : {"good", "bad"}) ASSERT_EQ(paint(server, map, 50, 6).exit_code, 0);
  }
  fs::resize_file(data + "/bad.earthwork", fs::file_size(data + "/bad.earthwork") / 2);
  const ServerProgram server({.data = data});
  const auto bad = link::http_get(server.address(), "/api/maps/bad/figures");
  ASSERT_TRUE(bad);
  EXPECT_EQ(bad->status, 500);
  EXPECT_NE(bad->body.find("bad.earthwork"), std::string::npos) << bad->body;
  const Outcome joined = bot({"watch", "--server", server.url(), "--map", "bad"});
  EXPECT_EQ(joined.exit_code, 2) << joined.err;
  EXPECT_NE(joined.err.find("bad.earthwork"), std::string::npos) << joined.err;
  EXPECT_EQ(figures(server, "good")["seq"], 50);
  EXPECT_EQ(paint(server, "good", 10, 7).exit_code, 0);
}

}  // namespace
}  // namespace earthwork::e2e
