// That the text rules find what they are there to find.
#include "tests/house/text_rules.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace earthwork::house {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::string repeat(std::string_view line, int times) {
  std::string text;
  for (int i = 0; i < times; ++i) text += line;
  return text;
}

TEST(TextRules, BoundAFilesLength) {
  EXPECT_THAT(check_length({"server/net/a.cpp", repeat("\n", 600)}), IsEmpty());
  EXPECT_THAT(check_length({"server/net/a.cpp", repeat("\n", 601)}),
              ElementsAre("server/net/a.cpp:601: longer than 600 lines"));
  EXPECT_THAT(check_length({"server/mesh/cell_tables.cpp", repeat("\n", 601)}), IsEmpty());
  EXPECT_THAT(check_length({"README.md", repeat("\n", 601)}), IsEmpty());
}

TEST(TextRules, BoundAFunctionsLength) {
  const std::string body = repeat("  call();\n", 68);
  EXPECT_THAT(check_functions({"a.cpp", "void f() {\n" + body + "}\n"}), IsEmpty());
  EXPECT_THAT(check_functions({"a.cpp", "\nvoid f() {\n" + body + "  call();\n}\n"}),
              ElementsAre("a.cpp:2: a function of 71 lines; 70 is the limit"));
}

TEST(TextRules, CountALongSignatureAsPartOfItsFunction) {
  const std::string head =
      "std::vector<int> Long::name(int first,\n" + std::string(22, ' ') + "int second) const {\n";
  EXPECT_EQ(check_functions({"a.cpp", head + repeat("  call();\n", 68) + "}\n"}).size(), 1u);
}

TEST(TextRules, FindLongFunctionsInsideAClass) {
  const std::string inside = "class A {\n  int f() {\n" + repeat("    call();\n", 69) + "  }\n};\n";
  EXPECT_THAT(check_functions({"a.hpp", inside}),
              ElementsAre("a.hpp:2: a function of 71 lines; 70 is the limit"));
}

TEST(TextRules, TakeDeclarationsAndLongClassesForWhatTheyAre) {
  const std::string declarations = repeat("int f(int a,\n      int b);\n", 60);
  EXPECT_THAT(check_functions({"a.hpp", declarations}), IsEmpty());
  const std::string members = repeat("  int f(int a);\n", 90);
  EXPECT_THAT(check_functions({"a.hpp", "class A {\n" + members + "};\n"}), IsEmpty());
}

TEST(TextRules, FindUnfinishedMarks) {
  const std::string mark = std::string("TO") + "DO";
  EXPECT_THAT(check_marks({"a.md", "done\n# " + mark + ": more\n"}),
              ElementsAre("a.md:2: unfinished: " + mark));
  EXPECT_THAT(check_marks({"a.cpp", "int " + mark + "S = 0;\n"}), IsEmpty());
}

TEST(TextRules, FindPlacesOfOneMachine) {
  EXPECT_EQ(check_places({"a.sh", std::string("cd /ho") + "me/me\n"}).size(), 1u);
  EXPECT_EQ(check_places({"a.json", std::string("https://registry.npm") + "js.org/x"}).size(), 1u);
  EXPECT_THAT(check_places({"a.sh", "cd \"$root/build\"\n"}), IsEmpty());
}

TEST(TextRules, FindSourcesThatAreNotBuilt) {
  const TextFile list = {"server/net/CMakeLists.txt", "add_library(net a.cpp)"};
  EXPECT_THAT(check_listed({list, {"server/net/a.cpp", ""}}), IsEmpty());
  EXPECT_THAT(check_listed({list, {"server/net/b.cpp", ""}}),
              ElementsAre("server/net/b.cpp: the CMakeLists.txt beside it does not name it"));
}

TEST(TextRules, CountLinesByWhatTheyAreFor) {
  const LineCount count = count_lines({{"server/a.cpp", "1\n2\n3"},
                                       {"client/page/a.mjs", "1\n"},
                                       {"tests/a_test.cpp", "1\n2\n"},
                                       {"README.md", "1\n"}});
  EXPECT_EQ(count.source, 4u);
  EXPECT_EQ(count.test, 2u);
}

int format_status(std::string_view source) {
  const std::string file = ::testing::TempDir() + "/house_format_sample.cpp";
  std::ofstream(file) << source;
  const int status =
      std::system((EARTHWORK_CLANG_FORMAT " --dry-run -Werror --style=file:" EARTHWORK_SOURCE_DIR
                                          "/.clang-format '" +
                   file + "' 2>" + file + ".log")
                      .c_str());
  std::filesystem::remove(file);
  std::filesystem::remove(file + ".log");
  return status;
}

TEST(TextRules, AreBackedByAFormatterThatObjects) {
  EXPECT_EQ(format_status("int f() { return 1; }\n"), 0);
  EXPECT_NE(format_status("int   f( ){return 1 ;}\n"), 0);
}

TEST(SourceTree, SplitsLinesWithAndWithoutAnEnd) {
  EXPECT_THAT(lines_of("a\n\nb"), ElementsAre("a", "", "b"));
  EXPECT_THAT(lines_of("a\n"), ElementsAre("a"));
  EXPECT_THAT(lines_of(""), IsEmpty());
}

}  // namespace
}  // namespace earthwork::house
