#include "tests/bench/fanout_crowd.hpp"

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <stdexcept>

#include "protocol/messages.hpp"

namespace earthwork::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kReadBytes = 256 * 1024;
constexpr unsigned char kTextMessage = 0x81, kPongMessage = 0x8a, kMasked = 0x80;
constexpr std::size_t kLength16 = 126;  // from here on two bytes say the length
constexpr std::size_t kMaskBytes = 4;   // a mask of zeros: the text stays as it is

constexpr const char* kHello = R"({"type":"hello","protocol":[1,1],"name":"crowd"})";
constexpr const char* kJoin = R"({"type":"join","map":"bench","id":1})";
constexpr const char* kView = R"({"type":"view","n":1,"all":true})";

}  // namespace

CrowdSocket::CrowdSocket(std::uint16_t port) : handle_(socket(AF_INET, SOCK_STREAM, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(handle_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    throw std::runtime_error("nobody listens");
  const int on = 1;
  setsockopt(handle_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
}

CrowdSocket::~CrowdSocket() { close(handle_); }

void CrowdSocket::upgrade(std::uint16_t port) {
  send_all("GET /ws HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
           "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
           "Sec-WebSocket-Key: ZWFydGh3b3JrIGNyb3dkIQ==\r\nSec-WebSocket-Version: 13\r\n"
           "Sec-WebSocket-Protocol: earthwork.v1\r\n\r\n");
  std::string answer;
  char letter = 0;
  while (!answer.ends_with("\r\n\r\n")) {
    if (recv(handle_, &letter, 1, 0) != 1) throw std::runtime_error("no WebSocket: " + answer);
    answer += letter;
  }
  if (!answer.starts_with("HTTP/1.1 101")) throw std::runtime_error("no WebSocket: " + answer);
}

void CrowdSocket::say(std::string_view text) {
  std::string message{static_cast<char>(kTextMessage)};
  if (text.size() < kLength16)
    message += static_cast<char>(kMasked | text.size());
  else
    message += {static_cast<char>(kMasked | kLength16), static_cast<char>(text.size() >> 8),
                static_cast<char>(text.size() & 0xff)};
  message.append(kMaskBytes, '\0');
  message += text;
  send_all(message);
}

void CrowdSocket::send_all(std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t sent = send(handle_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0) throw std::runtime_error("the peer has left");
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
}

bool CrowdSocket::read_some(int flags) {
  static std::array<unsigned char, kReadBytes> buffer;  // hot for all of them
  const ssize_t count = recv(handle_, buffer.data(), buffer.size(), flags);
  if (count < 0 && errno == EAGAIN) return false;
  if (count <= 0) throw std::runtime_error("the peer has left");
  stream_.feed(std::span(buffer).first(static_cast<std::size_t>(count)));
  for (; answered_pings_ < stream_.counts().pings; ++answered_pings_) {
    std::string pong{static_cast<char>(kPongMessage), static_cast<char>(kMasked)};
    send_all(pong.append(kMaskBytes, '\0'));
  }
  return static_cast<std::size_t>(count) == buffer.size();
}

void CrowdSocket::wait_for_texts(std::uint64_t count) {
  while (stream_.counts().texts < count) read_some(0);
}

void CrowdSocket::drain() {
  while (read_some(MSG_DONTWAIT)) {
  }
}

Crowd::Crowd() : epoll_(epoll_create1(0)) {}

Crowd::~Crowd() { close(epoll_); }

CrowdSocket& Crowd::add(std::unique_ptr<CrowdSocket> socket) {
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.ptr = socket.get();
  if (epoll_ctl(epoll_, EPOLL_CTL_ADD, socket->handle(), &event) != 0)
    throw std::runtime_error("epoll");
  sockets_.push_back(std::move(socket));
  return *sockets_.back();
}

bool Crowd::drain_once(std::chrono::nanoseconds patience) {
  std::array<epoll_event, 256> events;
  const auto patience_ms = std::chrono::ceil<std::chrono::milliseconds>(patience).count();
  const int count = epoll_wait(epoll_, events.data(), static_cast<int>(events.size()),
                               static_cast<int>(std::max<std::int64_t>(0, patience_ms)));
  for (int i = 0; i < count; ++i)
    static_cast<CrowdSocket*>(events[static_cast<std::size_t>(i)].data.ptr)->drain();
  return count > 0;
}

void Crowd::drain_for(std::chrono::nanoseconds duration) {
  const auto end = Clock::now() + duration;
  for (auto now = Clock::now(); now < end; now = Clock::now()) drain_once(end - now);
}

void Crowd::drain_until_quiet(std::chrono::nanoseconds quiet) {
  while (drain_once(quiet)) {
  }
}

StreamCounts Crowd::counts() const {
  StreamCounts all;
  for (const auto& socket : sockets_) {
    const StreamCounts& counts = socket->stream().counts();
    all.messages += counts.messages;
    all.texts += counts.texts;
    all.records += counts.records;
    all.groups += counts.groups;
    all.bytes += counts.bytes;
    all.pings += counts.pings;
  }
  return all;
}

std::unique_ptr<CrowdSocket> join_as_viewer(std::uint16_t port) {
  auto socket = std::make_unique<CrowdSocket>(port);
  socket->upgrade(port);
  for (const char* text : {kHello, kJoin, kView}) socket->say(text);
  for (std::uint64_t texts = 1; !socket->stream().caught_up(); ++texts)
    socket->wait_for_texts(texts);
  return socket;
}

CrowdEditor::CrowdEditor(Crowd& crowd, std::uint16_t port)
    : socket_(crowd.add(std::make_unique<CrowdSocket>(port))) {
  socket_.upgrade(port);
  for (const char* text : {kHello, kJoin}) socket_.say(text);
  socket_.wait_for_texts(2);
}

void CrowdEditor::paint(const protocol::Edit& edit) {
  socket_.say(protocol::write(protocol::EditMessage{.id = ++last_id_, .edit = edit}));
}

}  // namespace earthwork::bench
