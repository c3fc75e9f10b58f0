/// A process that a benchmark measures from outside: its processor time and its memory.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <memory>

namespace earthwork::bench {

/// Killed when it goes out of scope, or when the benchmark dies.
class ChildProcess {
 public:
  /// A copy of this process that runs `work`; only while there is a single thread.
  explicit ChildProcess(const std::function<void()>& work);
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  ~ChildProcess();

  /// Of all its threads, user and system together, since it started.
  [[nodiscard]] double cpu_s() const;
  /// Resident now.
  [[nodiscard]] std::uint64_t memory_bytes() const;

 private:
  pid_t pid_ = -1;
};

/// `earthwork-server serve --memory` of this build on a free port of 127.0.0.1.
class BenchServer {
 public:
  /// Returns once it listens; throws std::runtime_error when it does not.
  BenchServer();
  ~BenchServer();
  BenchServer(const BenchServer&) = delete;
  BenchServer& operator=(const BenchServer&) = delete;
  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] const ChildProcess& process() const { return *process_; }

 private:
  int out_ = -1;  // what it prints; open as long as it runs
  std::uint16_t port_ = 0;
  std::unique_ptr<ChildProcess> process_;
};

/// As many open files as the system lets this process and its children have.
void raise_file_limit();

}  // namespace earthwork::bench
