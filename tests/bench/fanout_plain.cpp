#include "tests/bench/fanout_plain.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <stdexcept>
#include <string>
#include <vector>

namespace earthwork::bench {
namespace {

constexpr int kBacklog = 4096;

int listen_anywhere(std::uint16_t& port) {
  const int listener = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  if (bind(listener, reinterpret_cast<const sockaddr*>(&address), size) != 0 ||
      listen(listener, kBacklog) != 0 ||
      getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size) != 0)
    throw std::runtime_error("cannot listen");
  port = ntohs(address.sin_port);
  return listener;
}

std::string make_message(std::size_t bytes) {
  constexpr std::size_t kHeader = 4, kFrameHead = 2, kLength = 4;
  const std::size_t payload = bytes - kHeader, record = payload - kFrameHead - kLength;
  std::string out{static_cast<char>(0x82),           126, static_cast<char>(payload >> 8),
                  static_cast<char>(payload & 0xff), 1,   2};
  for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>(record >> shift & 0xff);
  return out.append(record, 'x');
}

struct Reader {
  int handle = -1;
  std::size_t due = 0;  // bytes
};

class Writer {
 public:
  Writer(int listener, int orders, std::size_t message_bytes)
      : listener_(listener), orders_(orders), message_bytes_(message_bytes) {
    for (std::size_t i = 0; i < kPlainMessages; ++i) messages_ += make_message(message_bytes);
    watch(listener_, EPOLLIN);
    watch(orders_, EPOLLIN);
  }

  void run() {
    std::array<epoll_event, 256> events;
    while (true) {
      const int count = epoll_wait(epoll_, events.data(), static_cast<int>(events.size()), -1);
      for (int i = 0; i < count; ++i) {
        const int handle = events[static_cast<std::size_t>(i)].data.fd;
        if (handle == listener_)
          accept_one();
        else if (handle == orders_)
          follow_order();
        else
          write(readers_[static_cast<std::size_t>(handle)]);
      }
    }
  }

 private:
  void watch(int handle, std::uint32_t what) const {
    epoll_event event{};
    event.events = what;
    event.data.fd = handle;
    epoll_ctl(epoll_, EPOLL_CTL_ADD, handle, &event);
  }

  void accept_one() {
    const int handle = accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK);
    if (handle < 0) throw std::runtime_error("accept");
    const int on = 1;
    setsockopt(handle, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    readers_.resize(std::max(readers_.size(), static_cast<std::size_t>(handle) + 1));
    readers_[static_cast<std::size_t>(handle)].handle = handle;
    watch(handle, EPOLLOUT | EPOLLET);
  }

  void follow_order() {
    char order = 0;
    if (read(orders_, &order, 1) != 1) _exit(0);
    sending_ = static_cast<Sending>(order);
    for (Reader& reader : readers_) {
      if (reader.handle < 0) continue;
      reader.due += messages_.size();
      write(reader);
    }
  }

  // The messages are all alike, so where one starts follows from what is still due.
  void write(Reader& reader) const {
    while (reader.due > 0) {
      const std::size_t unit = sending_ == Sending::together ? messages_.size() : message_bytes_;
      const std::size_t rest = reader.due % unit == 0 ? unit : reader.due % unit;
      const ssize_t sent =
          ::send(reader.handle, messages_.data() + (messages_.size() - rest), rest, MSG_NOSIGNAL);
      if (sent < 0 && errno == EAGAIN) return;
      if (sent < 0) {
        close(reader.handle);
        reader = {};
        return;
      }
      reader.due -= static_cast<std::size_t>(sent);
    }
  }

  int listener_, orders_;
  std::size_t message_bytes_;
  std::string messages_;
  Sending sending_ = Sending::together;
  std::vector<Reader> readers_;  // by handle
  int epoll_ = epoll_create1(0);
};

}  // namespace

PlainWriter::PlainWriter(std::size_t message_bytes) {
  const int listener = listen_anywhere(port_);
  std::array<int, 2> orders{};
  if (pipe(orders.data()) != 0) throw std::runtime_error("no pipe");
  process_ = std::make_unique<ChildProcess>([=] {
    close(orders[1]);
    Writer(listener, orders[0], message_bytes).run();
  });
  close(listener);
  close(orders[0]);
  orders_ = orders[1];
}

PlainWriter::~PlainWriter() { close(orders_); }

void PlainWriter::send(Sending how) const {
  const char order = static_cast<char>(how);
  if (write(orders_, &order, 1) != 1) throw std::runtime_error("the plain writer has ended");
}

}  // namespace earthwork::bench
