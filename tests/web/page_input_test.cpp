#include "client/viewer/web/page_input.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace earthwork::viewer {
namespace {

TEST(PageInput, KnowsTheButtonsOfAMouse) {
  EXPECT_EQ(button_of(0), PointerButton::left);
  EXPECT_EQ(button_of(1), PointerButton::middle);
  EXPECT_EQ(button_of(2), PointerButton::right);
  EXPECT_EQ(button_of(-1), PointerButton::none);
  EXPECT_EQ(button_of(3), std::nullopt);
  EXPECT_EQ(button_of(4), std::nullopt);
}

TEST(PageInput, TurnsLinesAndPagesOfAWheelIntoPixels) {
  EXPECT_EQ(wheel_pixels(-12.5, 0, 600), -12.5);
  EXPECT_EQ(wheel_pixels(3, 1, 600), 48);
  EXPECT_EQ(wheel_pixels(-1, 2, 600), -600);
  EXPECT_EQ(wheel_pixels(5, 7, 600), 5);
  EXPECT_EQ(wheel_pixels(std::numeric_limits<double>::infinity(), 0, 600), 0);
  EXPECT_EQ(wheel_pixels(std::numeric_limits<double>::quiet_NaN(), 1, 600), 0);
}

TEST(PageInput, LeavesTextFieldsEveryKey) {
  for (const char* key : {"a", " ", "Enter", "Escape", "ArrowLeft", "?"})
    EXPECT_TRUE(page_keeps(Focus::all_keys, key)) << key;
}

TEST(PageInput, GivesTheMapEveryKey) {
  for (const char* key : {"a", " ", "Enter", "Escape", "ArrowLeft", "Tab"})
    EXPECT_FALSE(page_keeps(Focus::map, key)) << key;
}

TEST(PageInput, LeavesSlidersAndChoicesWhatMovesThem) {
  for (const char* key : {"ArrowLeft", "ArrowUp", "Home", "End", "PageUp", "PageDown", " "})
    EXPECT_TRUE(page_keeps(Focus::moves, key)) << key;
  for (const char* key : {"a", "Enter", "[", "Escape"})
    EXPECT_FALSE(page_keeps(Focus::moves, key)) << key;
}

TEST(PageInput, LeavesButtonsWhatPressesThem) {
  EXPECT_TRUE(page_keeps(Focus::presses, "Enter"));
  EXPECT_TRUE(page_keeps(Focus::presses, " "));
  for (const char* key : {"a", "ArrowLeft", "Home", "Escape"})
    EXPECT_FALSE(page_keeps(Focus::presses, key)) << key;
}

}  // namespace
}  // namespace earthwork::viewer
