// The rules of the house, held against the tree as it is.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <set>

#include "tests/house/rooms.hpp"
#include "tests/house/source_tree.hpp"
#include "tests/house/text_rules.hpp"

namespace earthwork::house {
namespace {

const std::vector<TextFile>& tree() {
  static const std::vector<TextFile> files = read_tree(EARTHWORK_SOURCE_DIR);
  return files;
}

void expect_none(const Findings& findings) {
  for (const std::string& one : findings) ADD_FAILURE() << one;
}

void expect_all(Findings (*check)(const TextFile&)) {
  for (const TextFile& file : tree()) expect_none(check(file));
}

TEST(House, IsReadWhole) {
  std::set<std::string> folders;
  for (const TextFile& file : tree()) {
    if (is_cpp(file.path)) folders.insert(file.path.substr(0, file.path.find('/')));
  }
  EXPECT_TRUE(folders.contains("server"));
  EXPECT_TRUE(folders.contains("client"));
  EXPECT_TRUE(folders.contains("protocol"));
  EXPECT_TRUE(folders.contains("tests"));
}

TEST(House, IncludesFollowTheArrows) {
  std::set<std::string_view> known;
  for (const TextFile& file : tree()) known.insert(file.path);
  for (const TextFile& file : tree()) expect_none(check_includes(file, known));
}

TEST(House, SourcesAreBuilt) { expect_none(check_listed(tree())); }
TEST(House, FilesAreShort) { expect_all(check_length); }
TEST(House, FunctionsAreShort) { expect_all(check_functions); }
TEST(House, NothingIsMarkedUnfinished) { expect_all(check_marks); }
TEST(House, NamesNoMachineAndNoRegistry) { expect_all(check_places); }

TEST(House, IsFormatted) {
  std::string command =
      "cd '" EARTHWORK_SOURCE_DIR "' && " EARTHWORK_CLANG_FORMAT " --dry-run -Werror --style=file";
  for (const TextFile& file : tree()) {
    if (is_cpp(file.path)) command += " '" + file.path + "'";
  }
  EXPECT_EQ(std::system(command.c_str()), 0) << "mend it with clang-format -i";
}

TEST(House, HasSixLinesOfTestsForTenOfSource) {
  const LineCount count = count_lines(tree());
  ASSERT_GT(count.source, 0u);
  EXPECT_GE(count.test * 10, count.source * 6);
  std::printf("source lines %zu, test lines %zu (%zu %%)\n", count.source, count.test,
              count.test * 100 / count.source);
}

}  // namespace
}  // namespace earthwork::house
