// What stands behind a flag: decimal, whole where it has to be, finite, within its range.
#include "client/bot/flag_value.hpp"

#include <gtest/gtest.h>

namespace earthwork::bot {
namespace {

TEST(FlagValue, IsAWholeNumberInItsRange) {
  for (const char* text : {"3", "9", "007"}) EXPECT_EQ(check_whole(text, 3, 9), "") << text;
  for (const char* text :
       {"2", "10", "-4", "+4", " 4", "4 ", "4.0", "4e0", "0x4", "", "four", "18446744073709551620"})
    EXPECT_EQ(check_whole(text, 3, 9), "'" + std::string(text) + "' is no whole number of 3 .. 9");
}

TEST(FlagValue, IsAFiniteNumberInItsRange) {
  for (const char* text : {"0.5", "2", "2e0", "1.99999"})
    EXPECT_EQ(check_number(text, 0.5, 2), "") << text;
  for (const char* text : {"0.49", "2.01", "-1", "nan", "inf", "-nan", "0x1", "1s", "", "1e999"})
    EXPECT_EQ(check_number(text, 0.5, 2), "'" + std::string(text) + "' is no number of 0.5 .. 2");
}

}  // namespace
}  // namespace earthwork::bot
