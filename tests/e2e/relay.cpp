#include "tests/e2e/relay.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

namespace earthwork::e2e {
namespace {

// Sockets close on exec: a program that a test starts meanwhile would hold them open.
constexpr int kSocket = SOCK_STREAM | SOCK_CLOEXEC;
constexpr int kLookAgainMs = 10;
constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();

sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in out{};
  out.sin_family = AF_INET;
  out.sin_port = htons(port);
  out.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return out;
}

const sockaddr* generic(const sockaddr_in& address) {
  return reinterpret_cast<const sockaddr*>(&address);
}

/// Closed with a reset, as a broken wire looks to both sides.
void cut(int socket) {
  const linger hard{.l_onoff = 1, .l_linger = 0};
  setsockopt(socket, SOL_SOCKET, SO_LINGER, &hard, sizeof hard);
  close(socket);
}

bool write_all(int socket, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (n <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

bool readable(int socket) {
  pollfd wait{.fd = socket, .events = POLLIN, .revents = 0};
  return poll(&wait, 1, kLookAgainMs) > 0;
}

}  // namespace

/// One connection, from the client's first bytes to the end.
class Relay::Wire {
 public:
  Wire(Relay& relay, int client, const link::ServerAddress& server)
      : relay_(relay), ends_{client, socket(AF_INET, kSocket, 0)}, server_(server) {}

  void carry() {
    const sockaddr_in to = loopback(server_.port);
    if (connect(ends_[1], generic(to), sizeof to) == 0)
      while (!relay_.ended_ && step()) {
      }
    const bool broken = left_ == 0;
    for (const int end : ends_) broken ? cut(end) : static_cast<void>(close(end));
    if (broken) ++relay_.cuts_;
  }

 private:
  bool step() {
    std::array<pollfd, 2> wait{pollfd{.fd = ends_[0], .events = POLLIN, .revents = 0},
                               pollfd{.fd = ends_[1], .events = POLLIN, .revents = 0}};
    if (poll(wait.data(), wait.size(), kLookAgainMs) <= 0) return true;
    for (std::size_t from = 0; from < 2; ++from)
      if (wait[from].revents != 0 && !pass_on(from)) return false;
    return true;
  }

  bool pass_on(std::size_t from) {
    const ssize_t n = recv(ends_[from], buffer_.data(), std::min(buffer_.size(), left_), 0);
    if (n <= 0) return false;
    std::string bytes(buffer_.data(), static_cast<std::size_t>(n));
    if (!begun_) begin(bytes);
    bytes.resize(std::min(bytes.size(), left_));
    if (left_ != kNever) left_ -= bytes.size();
    return write_all(ends_[1 - from], bytes) && left_ > 0;
  }

  /// The server knows itself by another port.
  void begin(std::string& request) {
    begun_ = true;
    const std::string mine = relay_.address_.host_header();
    if (const auto at = request.find(mine); at != std::string::npos)
      request.replace(at, mine.size(), server_.host_header());
    if (request.starts_with("GET /ws "))
      left_ = relay_.plan_(relay_.connections_++).value_or(kNever);
  }

  Relay& relay_;
  const std::array<int, 2> ends_;  // the client's and the server's
  const link::ServerAddress server_;
  std::size_t left_ = kNever;  // bytes until the cut
  bool begun_ = false;
  std::array<char, 64 * 1024> buffer_;
};

Relay::Relay(const link::ServerAddress& server, Plan plan)
    : plan_(std::move(plan)), server_(server), listener_(socket(AF_INET, kSocket, 0)) {
  sockaddr_in here = loopback(0);
  socklen_t size = sizeof here;
  if (bind(listener_, generic(here), sizeof here) != 0 || listen(listener_, 16) != 0 ||
      getsockname(listener_, reinterpret_cast<sockaddr*>(&here), &size) != 0)
    throw std::runtime_error("no port for a relay");
  address_ = {.host = "127.0.0.1", .port = ntohs(here.sin_port)};
  thread_ = std::thread([this] { run(); });
}

Relay::~Relay() {
  ended_ = true;
  thread_.join();
  close(listener_);
}

void Relay::lead_to(const link::ServerAddress& server) {
  const std::scoped_lock lock(mutex_);
  server_ = server;
}

void Relay::run() {
  while (!ended_)
    if (readable(listener_))
      if (const int client = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC); client >= 0)
        serve(client);
}

void Relay::serve(int client) {
  std::unique_lock lock(mutex_);
  const link::ServerAddress server = server_;
  lock.unlock();
  Wire(*this, client, server).carry();
}

}  // namespace earthwork::e2e
