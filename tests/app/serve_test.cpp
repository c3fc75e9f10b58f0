// The program: its flags, what it prints where, and how it ends.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include "tests/e2e/program.hpp"

namespace earthwork::app {
namespace {

using e2e::Outcome;
using e2e::Program;

Outcome server(const std::vector<std::string>& arguments) {
  return Program("earthwork-server", arguments).wait();
}

int lines(const std::string& text) {
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

/// Waits for the end of a line, at most a minute.
bool prints_a_line(Program& program) {
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (program.out().find('\n') == std::string::npos) {
    if (program.ended() || std::chrono::steady_clock::now() > give_up) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

TEST(Server, SaysItsVersionAndWhatItCan) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--version"}, {"serve", "--version"}}) {
    const Outcome version = server(arguments);
    EXPECT_EQ(version.exit_code, 0);
    EXPECT_TRUE(version.out.starts_with("earthwork-server 0.")) << version.out;
  }
  EXPECT_NE(server({"--help"}).out.find("serve"), std::string::npos);
  const Outcome help = server({"serve", "--help"});
  EXPECT_EQ(help.exit_code, 0);
  for (const char* flag : {"--data", "--listen", "--memory", "--insecure-open"})
    EXPECT_NE(help.out.find(flag), std::string::npos) << flag;
}

TEST(Server, RefusesWrongUseInOneLine) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{},
        {"dance"},
        {"serve", "--dance"},
        {"serve", "extra"},
        {"serve", "--listen"},
        {"serve", "--listen", "nowhere"},
        {"serve", "--listen", "127.0.0.1:99999"},
        {"serve", "--listen", "0.0.0.0:0"},
        {"serve", "--listen", "[::]:0"},
        {"serve", "--listen", "192.0.2.1:0", "--insecure-open"}}) {
    const Outcome refused = server(arguments);
    EXPECT_EQ(refused.exit_code, 2) << testing::PrintToString(arguments);
    EXPECT_EQ(lines(refused.err), 1) << refused.err;
    EXPECT_EQ(refused.out, "");
  }
}

TEST(Server, NamesTheFlagThatOpensIt) {
  EXPECT_NE(server({"serve", "--listen", "0.0.0.0:0"}).err.find("--insecure-open"),
            std::string::npos);
}

TEST(Server, EndsWithZeroWhenItIsAsked) {
  for (const int signal : {SIGTERM, SIGINT}) {
    Program program("earthwork-server", {"serve", "--demo", "--listen", "127.0.0.1:0"});
    ASSERT_TRUE(prints_a_line(program));
    const auto start = std::chrono::steady_clock::now();
    program.signal(signal);
    const Outcome outcome = program.wait();
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_TRUE(outcome.out.starts_with("listening on http://127.0.0.1:")) << outcome.out;
    EXPECT_EQ(lines(outcome.out), 1);
    EXPECT_NE(outcome.err.find("in memory"), std::string::npos);
  }
}

TEST(Server, DoesNotListenTwiceInOnePlace) {
  e2e::ServerProgram first;
  const Outcome second = server({"serve", "--listen", first.address().text().substr(7)});
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_EQ(lines(second.err), 1);
}

}  // namespace
}  // namespace earthwork::app
