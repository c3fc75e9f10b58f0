#include "server/app/serve.hpp"

#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "server/app/answer.hpp"
#include "server/app/demo.hpp"
#include "server/journal/shelf.hpp"
#include "server/net/page_files.hpp"
#include "server/net/server.hpp"

namespace earthwork::app {
namespace {

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

// What the end comes to as long as not all is stored.
std::atomic<int> exit_code = kFailed;

/// Promises the end within 5 s, even while an export that nobody waits for any more is being made,
/// or while a disk does not answer.
void end_in_any_case() {
  std::thread([] {
    std::this_thread::sleep_for(std::chrono::milliseconds(4500));
    std::_Exit(exit_code);
  }).detach();
}

protocol::Result<std::shared_ptr<journal::Shelf>> take_shelf(const ServeFlags& flags) {
  if (flags.memory) return journal::make_memory_shelf();
  auto folder = journal::DataDirectory::open(flags.data, journal::DataDirectory::Missing::create);
  if (!folder) return tl::unexpected<protocol::Failure>(std::move(folder.error()));
  return journal::make_file_shelf(std::move(*folder));
}

/// The folder that was named, or the one that is installed with the program, if it is.
std::optional<std::filesystem::path> page_folder(const ServeFlags& flags) {
  if (!flags.page.empty()) return flags.page;
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  const auto folder = program.parent_path().parent_path() / "share" / "earthwork" / "page";
  if (error || !std::filesystem::is_directory(folder, error)) return std::nullopt;
  return folder;
}

/// Null when there is no page.
protocol::Result<std::shared_ptr<const net::PageFiles>> take_page(const ServeFlags& flags) {
  const auto folder = page_folder(flags);
  if (!folder) return nullptr;
  auto page = net::PageFiles::read(*folder);
  if (!page) return tl::unexpected<protocol::Failure>(std::move(page.error()));
  spdlog::info("the page is that of {}", std::filesystem::absolute(*folder).string());
  return std::make_shared<const net::PageFiles>(std::move(*page));
}

void say_where_maps_are(const ServeFlags& flags) {
  if (flags.memory)
    spdlog::info("in memory: maps are gone when the server ends");
  else
    spdlog::info("maps are kept in {}", std::filesystem::absolute(flags.data).string());
}

int end(net::Server& server) {
  end_in_any_case();
  if (server.stop())
    exit_code = kDone;
  else
    spdlog::error("ended before all that was accepted was stored; nobody was told that it was");
  return exit_code;
}

}  // namespace

int serve(const ServeFlags& flags) {
  const auto listen = net::parse_listen_address(flags.listen);
  if (!listen) return refuse(kUsage, "--listen: " + listen.error().detail);
  if (!listen->loopback() && !flags.insecure_open)
    return refuse(kUsage,
                  "--listen: " + flags.listen +
                      " is reachable from other machines, and anybody there could paint and delete "
                      "maps; --insecure-open allows it");

  const auto page = take_page(flags);
  if (!page) return refuse(kUsage, "--page: " + page.error().detail);

  const sigset_t signals = hold_end_signals();
  allow_many_connections();
  const auto shelf = take_shelf(flags);
  if (!shelf) return refuse(kUsage, "--data: " + shelf.error().detail);
  auto server = net::Server::start({.listen = *listen,
                                    .allowed_hosts = flags.allow_hosts,
                                    .limits = {},
                                    .shelf = *shelf,
                                    .idle = std::chrono::seconds(flags.idle_seconds),
                                    .page = *page});
  if (!server) return refuse(kUsage, server.error().detail);
  if (flags.demo) {
    std::promise<protocol::Result<void>> added;
    add_demo((*server)->atlas(), [&](const auto& result) { added.set_value(result); });
    if (const auto result = added.get_future().get(); !result)
      return refuse(kUsage, "--demo: " + result.error().detail);
  }

  say_where_maps_are(flags);
  std::printf("listening on %s\n", (*server)->url().c_str());
  std::fflush(stdout);

  wait_for_end(signals);
  return end(**server);
}

}  // namespace earthwork::app
