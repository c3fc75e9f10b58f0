// Files that are written whole or not at all.
#include "server/app/new_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/e2e/program.hpp"

namespace earthwork::app {
namespace {

std::size_t files_in(const std::string& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(NewFile, TakesThePlaceOfTheOneBeforeAtTheEnd) {
  const e2e::Folder folder;
  std::ofstream(folder / "a") << "before";
  NewFile file(folder / "a");
  ASSERT_TRUE(file.write("af"));
  ASSERT_TRUE(file.write("ter"));
  EXPECT_EQ(e2e::read_file(folder / "a"), "before");
  ASSERT_TRUE(file.finish());
  EXPECT_EQ(e2e::read_file(folder / "a"), "after");
  EXPECT_EQ(file.bytes(), 5u);
  EXPECT_EQ(files_in(folder / ""), 1u);
}

TEST(NewFile, LeavesNothingUnlessItIsFinished) {
  const e2e::Folder folder;
  {
    NewFile file(folder / "a");
    ASSERT_TRUE(file.write("half"));
    EXPECT_EQ(files_in(folder / ""), 1u);
  }
  EXPECT_EQ(files_in(folder / ""), 0u);
}

TEST(NewFile, SaysWhyItCannotBe) {
  const e2e::Folder folder;
  NewFile nowhere(folder / "no/such/a");
  const auto written = nowhere.write("a");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, protocol::Code::storage_failed);
  EXPECT_EQ(written.error().detail,
            (folder / "no/such/a") + " cannot be written: No such file or directory");

  std::filesystem::create_directory(folder / "taken");
  NewFile taken(folder / "taken");
  ASSERT_TRUE(taken.write("a"));
  EXPECT_EQ(taken.finish().error().code, protocol::Code::storage_failed);
}

}  // namespace
}  // namespace earthwork::app
