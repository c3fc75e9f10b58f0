// The programs of this build, run as a user would run them.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "client/link/server_address.hpp"

namespace earthwork::e2e {

struct Outcome {
  int exit_code = 0;  ///< 128 + its number when a signal ended the program.
  std::string out, err;
};

/// A program that runs, in a folder for its output; killed when it goes out of scope.
class Program {
 public:
  /// `name` is a file in the build's bin folder, or a path.
  Program(const std::string& name, const std::vector<std::string>& arguments);
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program();

  void signal(int number) const;
  /// What was printed so far.
  std::string out() const;
  /// Whether it has ended by itself.
  bool ended() { return reap(Reap::if_ended); }
  /// Waits for its end, at most a minute; a program that takes longer is killed.
  Outcome wait();

 private:
  enum class Reap { if_ended, wait };
  bool reap(Reap how);

  std::filesystem::path folder_;
  pid_t pid_ = -1;
  std::optional<int> status_;
};

/// earthwork-bot with these arguments, from start to end.
Outcome bot(const std::vector<std::string>& arguments);

/// How it ends with a stdout that takes nothing.
enum class Stdout { full, closed };
Outcome bot_without(Stdout missing, const std::vector<std::string>& arguments);

/// `earthwork-server serve`, until it goes out of scope: then it is asked to end, and the test
/// fails unless it does so with 0 (a sanitizer that found something makes it 1).
class ServerProgram {
 public:
  struct Flags {
    std::string data{};               ///< The folder it keeps maps in; empty: `--memory`.
    std::uint16_t port = 0;           ///< 0: a free one.
    std::vector<std::string> more{};  ///< Put behind the others.
  };

  ServerProgram() : ServerProgram(Flags{}) {}
  /// Returns once it listens; throws when it does not.
  explicit ServerProgram(const Flags& flags);
  ServerProgram(const ServerProgram&) = delete;
  ServerProgram& operator=(const ServerProgram&) = delete;
  ~ServerProgram();
  const link::ServerAddress& address() const { return address_; }
  std::string url() const { return address_.text(); }
  /// Asks it to end, as SIGTERM does.
  void ask_to_end() const;
  /// Ends it at once, as a crash would; that it did not end by itself is no failure then.
  void kill();
  /// Waits for its end.
  Outcome wait() { return program_.wait(); }

 private:
  Program program_;
  link::ServerAddress address_;
  bool killed_ = false;
};

/// A folder that goes with it.
class Folder {
 public:
  Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder();
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

std::string read_file(const std::string& path);

}  // namespace earthwork::e2e
