// The program: its flags, what it prints where, and how it ends.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <thread>
#include <vector>

#include "tests/e2e/program.hpp"
#include "tests/e2e/server_answers.hpp"

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

/// Whether a number in the text is the pid of a process that was started with this argument.
bool names_a_process_with(const std::string& argument, const std::string& text) {
  const std::regex number("[0-9]+");
  for (std::sregex_iterator at(text.begin(), text.end(), number), end; at != end; ++at)
    if (e2e::read_file("/proc/" + at->str() + "/cmdline").find(argument) != std::string::npos)
      return true;
  return false;
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
  for (const char* flag : {"--data", "--listen", "--memory", "--idle", "--insecure-open"})
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
        {"serve", "--idle", "0"},
        {"serve", "--idle", "soon"},
        {"serve", "--data", "/proc/nothing/here", "--listen", "127.0.0.1:0"},
        {"serve", "--memory", "--listen", "192.0.2.1:0", "--insecure-open"}}) {
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

TEST(Server, ServesThePageThatItIsGiven) {
  e2e::Folder folder;
  std::filesystem::create_directories(folder / "page");
  std::ofstream(folder / "page/index.html") << "<!doctype html><title>a page</title>";
  e2e::ServerProgram with({.more = {"--page", folder / "page"}});
  EXPECT_EQ(e2e::get(with, "/"), "<!doctype html><title>a page</title>");
  EXPECT_EQ(e2e::get(with, "/?map=demo"), e2e::get(with, "/"));
}

TEST(Server, DoesNotStartWithAPageThatItCannotServe) {
  e2e::Folder folder;
  std::filesystem::create_directories(folder / "page");
  for (const std::string& page : {folder / "page", folder / "nothing"}) {
    const Outcome refused =
        server({"serve", "--memory", "--listen", "127.0.0.1:0", "--page", page});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_EQ(refused.out, "");
    EXPECT_EQ(lines(refused.err), 1) << refused.err;
    EXPECT_NE(refused.err.find(page), std::string::npos) << refused.err;
  }
}

TEST(Server, EndsWithZeroWhenItIsAsked) {
  for (const int signal : {SIGTERM, SIGINT}) {
    Program program("earthwork-server", {"serve", "--memory", "--demo", "--listen", "127.0.0.1:0"});
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
  const Outcome second =
      server({"serve", "--memory", "--listen", first.address().text().substr(7)});
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_EQ(lines(second.err), 1);
}

TEST(Server, KeepsItsMapsInTheFolderThatItSays) {
  e2e::Folder folder;
  const std::string data = folder / "maps";
  std::string demo;
  for (int start = 0; start < 2; ++start) {
    e2e::ServerProgram server({.data = data, .more = {"--demo"}});
    const std::string described = e2e::get(server, "/api/maps/demo");
    if (start > 0) EXPECT_EQ(described, demo);  // its epoch too: it is painted once
    demo = described;
    server.ask_to_end();
    const Outcome outcome = server.wait();
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_NE(outcome.err.find(data), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.err.find("in memory"), std::string::npos) << outcome.err;
  }
  EXPECT_TRUE(std::filesystem::exists(data + "/demo.earthwork"));
}

TEST(Server, LeavesAFolderAloneThatAnotherOneUses) {
  e2e::Folder folder;
  const std::string data = folder / "maps";
  e2e::ServerProgram first({.data = data});
  const Outcome second = server({"serve", "--data", data, "--listen", "127.0.0.1:0"});
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_EQ(second.out, "");
  EXPECT_EQ(lines(second.err), 1);
  EXPECT_TRUE(names_a_process_with(data, second.err)) << second.err;
}

}  // namespace
}  // namespace earthwork::app
