#include "tests/link/fake_server.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <thread>
#include <utility>

namespace earthwork::link {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;

namespace {

class SocketPeer : public Peer {
 public:
  SocketPeer(tcp::socket socket, const std::string& subprotocol) : socket_(std::move(socket)) {
    socket_.set_option(websocket::stream_base::decorator([&](websocket::response_type& response) {
      if (!subprotocol.empty()) response.set(http::field::sec_websocket_protocol, subprotocol);
    }));
    error_code ignored;
    socket_.accept(ignored);
  }

  std::string read() override {
    beast::flat_buffer buffer;
    error_code error;
    socket_.read(buffer, error);
    if (error) return "closed " + std::to_string(socket_.reason().code);
    return (socket_.got_text() ? "" : "binary ") + beast::buffers_to_string(buffer.data());
  }
  std::size_t waiting_bytes() override { return socket_.next_layer().available(); }
  void write(const std::string& text) override { send(text, true); }
  void write_binary(const std::string& bytes) override { send(bytes, false); }
  void close(std::uint16_t code) override {
    error_code ignored;
    socket_.close(websocket::close_reason(code), ignored);
  }

 private:
  void send(const std::string& bytes, bool text) {
    error_code ignored;
    socket_.text(text);
    socket_.write(asio::buffer(bytes), ignored);
  }
  websocket::stream<tcp::socket> socket_;
};

}  // namespace

struct FakeServer::State {
  explicit State(std::function<void(tcp::socket)> play)
      : acceptor(context, tcp::endpoint(asio::ip::address_v4::loopback(), 0)),
        thread([this, play = std::move(play)] {
          while (!ended) {
            error_code error;
            tcp::socket socket(context);
            acceptor.accept(socket, error);
            if (!error && !ended) play(std::move(socket));
          }
        }) {}
  ~State() {
    ended = true;
    // A last connection ends the wait for one.
    error_code ignored;
    tcp::socket last(context);
    last.connect(acceptor.local_endpoint(), ignored);
    thread.join();
  }
  std::atomic<bool> ended = false;
  asio::io_context context;
  tcp::acceptor acceptor;
  std::thread thread;
};

FakeServer::FakeServer(std::string subprotocol, std::function<void(Peer&)> play)
    : state_(std::make_unique<State>(
          [subprotocol = std::move(subprotocol), play = std::move(play)](tcp::socket socket) {
            SocketPeer peer(std::move(socket), subprotocol);
            play(peer);
          })) {}

FakeServer::FakeServer(std::string answer, std::string* request)
    : state_(std::make_unique<State>([answer = std::move(answer), request](tcp::socket socket) {
        beast::flat_buffer buffer;
        http::request<http::string_body> asked;
        error_code ignored;
        http::read(socket, buffer, asked, ignored);
        if (request) {
          std::ostringstream text;
          text << asked;
          *request = text.str();
        }
        char byte = 0;
        if (answer.empty()) asio::read(socket, asio::buffer(&byte, 1), ignored);
        asio::write(socket, asio::buffer(answer), ignored);
        socket.shutdown(tcp::socket::shutdown_both, ignored);
      })) {}

FakeServer::~FakeServer() = default;

ServerAddress FakeServer::address() const {
  return {.host = "127.0.0.1", .port = state_->acceptor.local_endpoint().port()};
}

ServerAddress nobody() {
  asio::io_context context;
  const tcp::acceptor closed_at_once(context, tcp::endpoint(asio::ip::address_v4::loopback(), 0));
  return {.host = "127.0.0.1", .port = closed_at_once.local_endpoint().port()};
}

}  // namespace earthwork::link
