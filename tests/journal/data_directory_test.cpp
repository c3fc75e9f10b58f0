// The folder of maps: one process at a time, maps by their names, and what a crash left is cleared.
#include "server/journal/data_directory.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>

#include "server/journal/durable_files.hpp"
#include "server/journal/map_file.hpp"
#include "tests/journal/sample_log.hpp"

namespace earthwork::journal {
namespace {

using protocol::Code;
using Missing = DataDirectory::Missing;

TEST(DataDirectory, IsMadeOnlyWhenAskedFor) {
  TemporaryFolder folder;
  const auto refused = DataDirectory::open(folder / "a/b", Missing::refuse);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::unknown_map);
  EXPECT_FALSE(std::filesystem::exists(folder / "a"));
  EXPECT_TRUE(DataDirectory::open(folder / "a/b", Missing::create));
  EXPECT_TRUE(DataDirectory::open(folder / "a/b", Missing::refuse));
}

TEST(DataDirectory, NamesItsMaps) {
  TemporaryFolder folder;
  const auto directory = DataDirectory::open(folder.path(), Missing::create).value();
  EXPECT_EQ(directory->map_file("x_1"), folder / "x_1.earthwork");
  for (const char* name :
       {"b.earthwork", "a-2.earthwork", "B.earthwork", ".earthwork", "notes", "a.earthwork-wal"})
    write_bytes(folder / name, "");
  std::filesystem::create_directory(folder / "c.earthwork");
  std::filesystem::create_symlink(folder / "b.earthwork", folder / "d.earthwork");
  EXPECT_EQ(directory->map_names().value(), (std::vector<std::string>{"a-2", "b"}));
}

TEST(DataDirectory, IsRefusedWhileAnotherProcessHasItAndNamesIt) {
  TemporaryFolder folder;
  int ready[2], end[2];
  ASSERT_EQ(::pipe(ready), 0);
  ASSERT_EQ(::pipe(end), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(end[1]);
    const auto held = DataDirectory::open(folder.path(), Missing::create);
    char byte = held ? 'y' : 'n';
    static_cast<void>(!::write(ready[1], &byte, 1));
    static_cast<void>(!::read(end[0], &byte, 1));  // until the parent closes its end
    ::_exit(0);
  }
  char byte = 0;
  ASSERT_EQ(::read(ready[0], &byte, 1), 1);
  EXPECT_EQ(byte, 'y');
  const auto refused = DataDirectory::open(folder.path(), Missing::create);
  ::close(end[1]);
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  for (const int file : {ready[0], ready[1], end[0]}) ::close(file);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::bad_state);
  EXPECT_EQ(refused.error().detail,
            folder.path().string() + " is in use by process " + std::to_string(child));
  EXPECT_TRUE(DataDirectory::open(folder.path(), Missing::create)) << "the lock went with it";
}

TEST(DataDirectory, ClearsWhatWasNotFinished) {
  TemporaryFolder folder;
  const auto unfinished = unfinished_path(folder / "a.earthwork");
  write_bytes(unfinished, "half a map");
  write_bytes(unfinished.string() + "-wal", "half a log");
  write_bytes(folder / ".kept", "somebody's");
  ASSERT_TRUE(create_map_file(folder / "b.earthwork", sample_identity()));
  const auto directory = DataDirectory::open(folder.path(), Missing::create).value();
  EXPECT_FALSE(std::filesystem::exists(unfinished));
  EXPECT_FALSE(std::filesystem::exists(unfinished.string() + "-wal"));
  EXPECT_TRUE(std::filesystem::exists(folder / ".kept"));
  EXPECT_EQ(directory->map_names().value(), std::vector<std::string>{"b"});
}

}  // namespace
}  // namespace earthwork::journal
