// Shelves: where a server's maps are, by name.
#include "server/journal/shelf.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <future>

namespace earthwork::journal {
namespace {

using protocol::Code;

Identity identity(std::uint64_t epoch) {
  return {.settings = {.chunk_resolution = 16, .chunks = {}}, .epoch = epoch, .created_ms = 1};
}

history::Event first_event() {
  return {.seq = 1,
          .time_ms = 5,
          .author = 7,
          .id = 3,
          .action = protocol::Edit{.radius = 2, .path = {{1, 2}}, .stroke = {}},
          .hash = 9};
}

TEST(MemoryShelf, KeepsNothing) {
  const auto shelf = make_memory_shelf();
  EXPECT_FALSE(shelf->kept());
  const auto made = shelf->create("a", identity(5));
  ASSERT_TRUE(made);
  EXPECT_EQ((*made)->identity(), identity(5));
  EXPECT_TRUE(shelf->names().value().empty());
  EXPECT_EQ(shelf->open("a").error().code, Code::unknown_map);
  EXPECT_TRUE(shelf->remove("a"));
}

TEST(MemoryShelf, ItsClerksWorkWithinTheCall) {
  const auto shelf = make_memory_shelf();
  const auto clerk = shelf->hire(shelf->create("a", identity(5)).value()).value();
  std::uint64_t seq = 0;
  clerk->post(Urgency::now, [&](Journal& journal) {
    EXPECT_TRUE(journal.append(0, std::vector{first_event()}));
    seq = journal.last_seq();
  });
  EXPECT_EQ(seq, 1u);
}

struct FileShelfTest : testing::Test {
  FileShelfTest() {
    std::string made = (std::filesystem::temp_directory_path() / "earthwork-XXXXXX").string();
    folder = mkdtemp(made.data());
    open_shelf();
  }
  ~FileShelfTest() override {
    shelf.reset();
    std::filesystem::remove_all(folder);
  }
  void open_shelf() {
    shelf.reset();
    auto directory = DataDirectory::open(folder, DataDirectory::Missing::refuse);
    shelf = make_file_shelf(std::move(directory).value());
  }

  std::filesystem::path folder;
  std::unique_ptr<Shelf> shelf;
};

TEST_F(FileShelfTest, KeepsMapsUnderTheirNames) {
  EXPECT_TRUE(shelf->kept());
  ASSERT_TRUE(shelf->create("b", identity(5)));
  ASSERT_TRUE(shelf->create("a", identity(6)));
  EXPECT_EQ(shelf->create("a", identity(7)).error().code, Code::map_exists);
  open_shelf();
  EXPECT_EQ(shelf->names().value(), (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(shelf->open("b").value()->identity(), identity(5));
  EXPECT_EQ(shelf->open("c").error().code, Code::unknown_map);
}

TEST_F(FileShelfTest, WhatItsClerksAppendIsThereAgain) {
  {
    const auto clerk = shelf->hire(shelf->create("a", identity(5)).value()).value();
    std::promise<bool> appended;
    clerk->post(Urgency::now, [&](Journal& journal) {
      appended.set_value(journal.append(0, std::vector{first_event()}).has_value());
    });
    EXPECT_TRUE(appended.get_future().get());
  }
  EXPECT_EQ(shelf->open("a").value()->last_seq(), 1u);
}

TEST_F(FileShelfTest, RemovesAMapWithAllThatLiesBesideIt) {
  ASSERT_TRUE(shelf->create("a", identity(5)));
  ASSERT_TRUE(shelf->create("b", identity(6)));
  EXPECT_TRUE(shelf->remove("a"));
  EXPECT_EQ(shelf->remove("a").error().code, Code::unknown_map);
  EXPECT_EQ(shelf->names().value(), std::vector<std::string>{"b"});
  for (const auto& file : std::filesystem::directory_iterator(folder))
    EXPECT_FALSE(file.path().filename().string().starts_with("a.")) << file.path();
}

TEST_F(FileShelfTest, NamesAFileThatIsNoMap) {
  std::ofstream(folder / "x.earthwork") << std::string(5000, 'x');
  EXPECT_EQ(shelf->names().value(), std::vector<std::string>{"x"});
  EXPECT_EQ(shelf->open("x").error().code, Code::damaged);
}

}  // namespace
}  // namespace earthwork::journal
