#include "server/net/server.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "server/net/api.hpp"
#include "server/net/connections.hpp"
#include "server/net/http_connection.hpp"
#include "server/net/workers.hpp"
#include "server/room/asio_strand.hpp"

namespace earthwork::net {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

constexpr auto kAwait = asio::as_tuple(asio::use_awaitable);
// What sessions have to end in, and all of the end together: the rest is for the maps.
constexpr std::chrono::milliseconds kSessionsPatience{2000}, kStopPatience{3800};
constexpr int kWorkerThreads = 1;
// That are being told at a time that there are too many; yet more are closed without a word.
constexpr std::size_t kMaxTurnedAway = 64;

/// Until the context is stopped. What a handler throws has ended that handler; the thread goes on
/// with the others.
void keep_running(asio::io_context& context) {
  while (!context.stopped()) {
    try {
      context.run();
    } catch (const std::exception& error) {
      spdlog::error("a handler failed: {}", error.what());
    }
  }
}

}  // namespace

/// Destroyed from the bottom up: what holds coroutines and tasks goes before the context that
/// they run on.
struct Server::Running {
  explicit Running(const ServerOptions& options)
      : acceptor(asio::make_strand(context)),
        address(options.listen),
        atlas(atlas_options(options)),
        limits(options.limits) {}

  room::AtlasOptions atlas_options(const ServerOptions& options);
  void listen();
  asio::awaitable<void> accept();
  void admit(tcp::socket socket);

  asio::io_context context;
  asio::executor_work_guard<asio::io_context::executor_type> work = asio::make_work_guard(context);
  tcp::acceptor acceptor;
  ListenAddress address;
  room::Atlas atlas;
  Connections connections, turned_away;
  SessionLimits limits;
  Workers workers{kWorkerThreads};
  std::optional<Api> api;
  // For the atlas, which never has more for them than they take.
  Workers keepers{room::kMaxMapsUnderWay};
  std::once_flag stopped;
  bool all_stored = true;
  std::vector<std::jthread> threads;
};

room::AtlasOptions Server::Running::atlas_options(const ServerOptions& options) {
  room::AtlasOptions made{
      .make_strand = [this] { return room::make_asio_strand(context.get_executor()); },
      .aside =
          [this](room::Strand::Task task) {
            [[maybe_unused]] const bool taken = keepers.offer(std::move(task));
          },
      .idle = options.idle};
  if (options.shelf) made.shelf = options.shelf;
  return made;
}

void Server::Running::listen() {
  const tcp::endpoint endpoint(asio::ip::make_address(address.numeric_host()), address.port);
  acceptor.open(endpoint.protocol());
  acceptor.set_option(tcp::acceptor::reuse_address(true));
  acceptor.bind(endpoint);
  acceptor.listen();
  address.port = acceptor.local_endpoint().port();
}

asio::awaitable<void> Server::Running::accept() {
  asio::steady_timer pause(acceptor.get_executor());
  for (;;) {
    auto [error, socket] = co_await acceptor.async_accept(asio::make_strand(context), kAwait);
    if (error == asio::error::operation_aborted || !acceptor.is_open()) co_return;
    if (error) {
      // Out of file descriptors, most likely: others must end first.
      spdlog::warn("a connection could not be accepted: {}", error.message());
      pause.expires_after(std::chrono::milliseconds(100));
      co_await pause.async_wait(kAwait);
      continue;
    }
    admit(std::move(socket));
  }
}

void Server::Running::admit(tcp::socket socket) {
  auto reception = Reception::served;
  Connections* list = &connections;
  std::optional<Connections::Id> id;
  try {
    id = list->admit(limits.connections);
    if (!id) {
      reception = Reception::turned_away;
      list = &turned_away;
      id = list->admit(kMaxTurnedAway);
    }
    if (!id) return;
    const auto executor = socket.get_executor();
    const Service wanted{atlas, *api, *list, limits};
    asio::co_spawn(executor, serve_connection(std::move(socket), wanted, *id, reception),
                   asio::detached);
  } catch (const std::exception& error) {
    spdlog::warn("a connection could not be served: {}", error.what());
    if (id) list->remove(*id);
  }
}

protocol::Result<std::unique_ptr<Server>> Server::start(const ServerOptions& options) {
  auto running = std::make_unique<Running>(options);
  if (auto known = running->atlas.take_stock(); !known)
    return tl::unexpected<protocol::Failure>(std::move(known.error()));
  try {
    running->listen();
  } catch (const boost::system::system_error& error) {
    return protocol::fail(
        protocol::Code::bad_field,
        "cannot listen on " + options.listen.text() + ": " + error.code().message(), "listen");
  }
  running->api.emplace(running->atlas, running->workers,
                       Access(running->address, options.allowed_hosts), options.page);
  asio::co_spawn(running->acceptor.get_executor(), running->accept(), asio::detached);

  const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const int threads = options.threads > 0 ? options.threads : cores;
  for (int i = 0; i < threads; ++i)
    running->threads.emplace_back([context = &running->context] { keep_running(*context); });
  return std::unique_ptr<Server>(new Server(std::move(running)));
}

Server::Server(std::unique_ptr<Running> running) : running_(std::move(running)) {}

Server::~Server() { stop(); }

const ListenAddress& Server::address() const { return running_->address; }

room::Atlas& Server::atlas() { return running_->atlas; }

bool Server::stop() {
  std::call_once(running_->stopped, [this] {
    const auto end = std::chrono::steady_clock::now() + kStopPatience;
    asio::post(running_->acceptor.get_executor(), [running = running_.get()] {
      boost::system::error_code ignored;
      running->acceptor.close(ignored);
    });
    running_->turned_away.stop_all(std::chrono::milliseconds(0));
    running_->connections.stop_all(kSessionsPatience);
    running_->all_stored =
        running_->atlas.stop(std::chrono::duration_cast<std::chrono::milliseconds>(
            end - std::chrono::steady_clock::now()));
    running_->context.stop();
    running_->threads.clear();
  });
  return running_->all_stored;
}

}  // namespace earthwork::net
