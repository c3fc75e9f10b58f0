#include "server/app/serve.hpp"

#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "server/app/demo.hpp"
#include "server/net/server.hpp"

namespace earthwork::app {
namespace {

constexpr int kDone = 0, kUsage = 2;

int refuse(const std::string& why) {
  std::fprintf(stderr, "earthwork-server: %s\n", why.c_str());
  return kUsage;
}

/// Held back from every thread started later, so that `wait_for_end` alone sees them.
sigset_t hold_end_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  return signals;
}

void wait_for_end(const sigset_t& signals) {
  int signal = 0;
  sigwait(&signals, &signal);
  spdlog::info("ending: {}", signal == SIGINT ? "SIGINT" : "SIGTERM");
}

/// A connection is a file descriptor, and the usual soft limit is 1,024 of them.
void allow_many_connections() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);
}

/// Promises the end within 5 s, even while an export that nobody waits for any more is being made.
void end_in_any_case() {
  std::thread([] {
    std::this_thread::sleep_for(std::chrono::milliseconds(4500));
    std::_Exit(kDone);
  }).detach();
}

}  // namespace

int serve(const ServeFlags& flags) {
  const auto listen = net::parse_listen_address(flags.listen);
  if (!listen) return refuse("--listen: " + listen.error().detail);
  if (!listen->loopback() && !flags.insecure_open)
    return refuse("--listen: " + flags.listen +
                  " is reachable from other machines, and anybody there could paint and delete "
                  "maps; --insecure-open allows it");

  const sigset_t signals = hold_end_signals();
  allow_many_connections();
  auto server =
      net::Server::start({.listen = *listen, .allowed_hosts = flags.allow_hosts, .limits = {}});
  if (!server) return refuse(server.error().detail);
  if (flags.demo) {
    if (const auto added = add_demo((*server)->atlas()); !added)
      return refuse("--demo: " + added.error().detail);
  }

  spdlog::info("in memory: maps are gone when the server ends{}",
               flags.memory ? "" : ", for this build has no journal yet and leaves --data alone");
  std::printf("listening on %s\n", (*server)->url().c_str());
  std::fflush(stdout);

  wait_for_end(signals);
  end_in_any_case();
  (*server)->stop();
  return kDone;
}

}  // namespace earthwork::app
