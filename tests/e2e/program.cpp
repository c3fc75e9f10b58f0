#include "tests/e2e/program.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace earthwork::e2e {
namespace {

using namespace std::chrono_literals;

constexpr auto kPatience = 60s;
constexpr auto kLookAgain = 2ms;

std::filesystem::path new_folder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "earthwork-e2e-XXXXXX").string();
  if (!mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder: " + pattern);
  return pattern;
}

/// In the child: never returns.
[[noreturn]] void become(char* const* argv, const char* out, const char* err) {
  // A test that crashes leaves no program behind.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int streams[] = {open("/dev/null", O_RDONLY), open(out, O_WRONLY | O_CREAT, 0600),
                         open(err, O_WRONLY | O_CREAT, 0600)};
  for (int i = 0; i < 3; ++i) dup2(streams[i], i);
  execv(argv[0], argv);
  _exit(127);
}

pid_t spawn(const std::string& name, const std::vector<std::string>& arguments,
            const std::filesystem::path& folder) {
  const std::string path = (std::filesystem::path(EARTHWORK_BIN_DIR) / name).string();
  std::vector<char*> argv{const_cast<char*>(path.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const std::string out = (folder / "out").string(), err = (folder / "err").string();
  const pid_t pid = fork();
  if (pid == 0) become(argv.data(), out.c_str(), err.c_str());
  if (pid < 0) throw std::runtime_error(path + " cannot be run");
  return pid;
}

std::vector<std::string> serve_arguments(const ServerProgram::Flags& flags) {
  std::vector<std::string> out{"serve", "--listen", "127.0.0.1:" + std::to_string(flags.port)};
  if (flags.data.empty())
    out.emplace_back("--memory");
  else
    out.insert(out.end(), {"--data", flags.data});
  out.insert(out.end(), flags.more.begin(), flags.more.end());
  return out;
}

}  // namespace

std::string read_file(const std::string& path) {
  const std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

Program::Program(const std::string& name, const std::vector<std::string>& arguments)
    : folder_(new_folder()), pid_(spawn(name, arguments, folder_)) {}

Program::~Program() {
  if (!status_) {
    signal(SIGKILL);
    reap(Reap::wait);
  }
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

void Program::signal(int number) const {
  if (!status_) ::kill(pid_, number);  // its number may be somebody else's by now
}

std::string Program::out() const { return read_file((folder_ / "out").string()); }

bool Program::reap(Reap how) {
  int status = 0;
  if (!status_ && waitpid(pid_, &status, how == Reap::wait ? 0 : WNOHANG) == pid_)
    status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return status_.has_value();
}

Outcome Program::wait() {
  const auto give_up = std::chrono::steady_clock::now() + kPatience;
  while (!ended()) {
    if (std::chrono::steady_clock::now() > give_up) {
      signal(SIGKILL);
      reap(Reap::wait);
    }
    std::this_thread::sleep_for(kLookAgain);
  }
  return {.exit_code = *status_, .out = out(), .err = read_file((folder_ / "err").string())};
}

Outcome bot(const std::vector<std::string>& arguments) {
  return Program("earthwork-bot", arguments).wait();
}

Outcome bot_without(Stdout missing, const std::vector<std::string>& arguments) {
  std::vector<std::string> all{
      "-c", std::string("exec \"$0\" \"$@\" ") + (missing == Stdout::full ? ">/dev/full" : ">&-"),
      (std::filesystem::path(EARTHWORK_BIN_DIR) / "earthwork-bot").string()};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return Program("/bin/sh", all).wait();
}

ServerProgram::ServerProgram(const Flags& flags)
    : program_("earthwork-server", serve_arguments(flags)) {
  const std::string announcement = "listening on ";
  const auto give_up = std::chrono::steady_clock::now() + kPatience;
  while (std::chrono::steady_clock::now() < give_up && !program_.ended()) {
    const std::string out = program_.out();
    const auto start = out.find(announcement);
    const auto end = out.find('\n', start);
    if (start != std::string::npos && end != std::string::npos) {
      const auto begin = start + announcement.size();
      const auto address = link::parse_server(out.substr(begin, end - begin));
      if (!address) throw std::runtime_error(address.error().detail);
      address_ = *address;
      return;
    }
    std::this_thread::sleep_for(kLookAgain);
  }
  program_.signal(SIGKILL);
  throw std::runtime_error("earthwork-server does not listen: " + program_.wait().err);
}

ServerProgram::~ServerProgram() {
  if (killed_) return;
  ask_to_end();
  const Outcome outcome = program_.wait();
  EXPECT_EQ(outcome.exit_code, 0) << "earthwork-server: " << outcome.err;
}

void ServerProgram::ask_to_end() const { program_.signal(SIGTERM); }

void ServerProgram::kill() {
  killed_ = true;
  program_.signal(SIGKILL);
  program_.wait();
}

Folder::Folder() : path_(new_folder()) {}

Folder::~Folder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace earthwork::e2e
