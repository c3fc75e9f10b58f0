// The settings that a map has, and those that anybody may know.
#include "server/room/settings_book.hpp"

#include <gtest/gtest.h>

#include "tests/room/onlooker.hpp"

namespace earthwork::room {
namespace {

history::Event event(std::uint64_t seq, protocol::Action action) {
  return {.seq = seq, .time_ms = 0, .author = 7, .id = 1, .action = std::move(action), .hash = 0};
}

TEST(SettingsBook, ShowsWhatIsStoredAndHasWhatIsAccepted) {
  SettingsBook book({});
  book.accept(add_layer("a"));
  book.accept(add_layer("b"));
  EXPECT_EQ(book.accepted().layers.size(), 3u);
  EXPECT_EQ(*book.durable(), protocol::MapSettings{});
  const auto before = book.durable();
  EXPECT_EQ(book.store(std::vector{event(1, disc(0, 0, 1)), event(2, add_layer("a")),
                                   event(3, disc(0, 0, 1))}),
            2u);
  EXPECT_EQ(book.durable()->layers.size(), 2u);
  EXPECT_EQ(before->layers.size(), 1u);  // who has it keeps it
  EXPECT_EQ(book.store(std::vector{event(4, disc(0, 0, 1))}), 0u);
}

TEST(SettingsBook, TakesBackWhatIsNotStored) {
  SettingsBook book({});
  book.accept(rename_layer(0, "a"));
  static_cast<void>(book.store(std::vector{event(1, rename_layer(0, "a"))}));
  book.accept(rename_layer(0, "b"));
  book.accept(add_layer("c"));
  book.take_back();
  EXPECT_EQ(book.accepted(), *book.durable());
  EXPECT_EQ(book.accepted().layers[0].name, "a");
}

}  // namespace
}  // namespace earthwork::room
