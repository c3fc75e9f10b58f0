#include "tests/bench/child_process.hpp"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <ctime>
#include <fstream>
#include <stdexcept>
#include <string>

namespace earthwork::bench {
namespace {

[[noreturn]] void become_server(const std::array<int, 2>& out) {
  dup2(out[1], STDOUT_FILENO);
  for (const int end : out) close(end);
  const std::string path = std::string(EARTHWORK_BIN_DIR) + "/earthwork-server";
  execl(path.c_str(), path.c_str(), "serve", "--memory", "--listen", "127.0.0.1:0", nullptr);
  _exit(127);
}

/// From the line "listening on http://127.0.0.1:PORT".
std::uint16_t read_port(int out) {
  std::string line;
  char letter = 0;
  while (read(out, &letter, 1) == 1) {
    if (letter != '\n') {
      line += letter;
    } else if (line.starts_with("listening on ")) {
      return static_cast<std::uint16_t>(std::stoi(line.substr(line.rfind(':') + 1)));
    } else {
      line.clear();
    }
  }
  throw std::runtime_error("earthwork-server does not listen");
}

}  // namespace

ChildProcess::ChildProcess(const std::function<void()>& work) : pid_(fork()) {
  if (pid_ < 0) throw std::runtime_error("no process");
  if (pid_ > 0) return;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  try {
    work();
  } catch (...) {
    _exit(1);
  }
  _exit(0);
}

ChildProcess::~ChildProcess() {
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

double ChildProcess::cpu_s() const {
  clockid_t clock{};
  timespec time{};
  if (clock_getcpuclockid(pid_, &clock) != 0 || clock_gettime(clock, &time) != 0)
    throw std::runtime_error("the process has ended");
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
}

std::uint64_t ChildProcess::memory_bytes() const {
  std::ifstream file("/proc/" + std::to_string(pid_) + "/statm");
  std::uint64_t all = 0, resident = 0;
  file >> all >> resident;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

BenchServer::BenchServer() {
  std::array<int, 2> out{};
  if (pipe(out.data()) != 0) throw std::runtime_error("no pipe");
  process_ = std::make_unique<ChildProcess>([&out] { become_server(out); });
  close(out[1]);
  out_ = out[0];
  port_ = read_port(out_);
}

BenchServer::~BenchServer() { close(out_); }

void raise_file_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  static_cast<void>(setrlimit(RLIMIT_NOFILE, &limit));
}

}  // namespace earthwork::bench
