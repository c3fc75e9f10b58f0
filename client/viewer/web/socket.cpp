#include "client/viewer/web/socket.hpp"

#include <emscripten/html5.h>
#include <emscripten/websocket.h>

#include <array>
#include <string>

#include "client/viewer/web/browser.hpp"

namespace earthwork::viewer {
namespace {

constexpr const char* kSubprotocol = "earthwork.v1";
constexpr unsigned short kNormal = 1000, kNoClosingCode = 1006;
constexpr unsigned short kOpen = 1;  // WebSocket.readyState
constexpr std::size_t kLongestAddress = 512;

SocketListener& listener_of(void* user) { return *static_cast<SocketListener*>(user); }

EM_BOOL on_open(int, const EmscriptenWebSocketOpenEvent*, void* user) {
  listener_of(user).socket_opened();
  return EM_TRUE;
}

// A text's bytes are counted with the NUL behind them.
EM_BOOL on_message(int, const EmscriptenWebSocketMessageEvent* event, void* user) {
  if (event->isText) {
    listener_of(user).socket_told(
        std::string_view(reinterpret_cast<const char*>(event->data), event->numBytes - 1));
  } else {
    listener_of(user).socket_told(
        std::as_bytes(std::span<const std::uint8_t>(event->data, event->numBytes)));
  }
  return EM_TRUE;
}

EM_BOOL on_close(int, const EmscriptenWebSocketCloseEvent* event, void* user) {
  const std::string reason = event->reason;
  listener_of(user).socket_closed(event->code, reason);
  return EM_TRUE;
}

}  // namespace

bool Socket::has_server() {
  std::array<char, kLongestAddress> address{};
  return browser_socket_address(address.data(), static_cast<int>(address.size())) > 0;
}

void Socket::open() {
  close();
  std::array<char, kLongestAddress> address{};
  browser_socket_address(address.data(), static_cast<int>(address.size()));
  EmscriptenWebSocketCreateAttributes attributes{address.data(), kSubprotocol, EM_TRUE};
  handle_ = emscripten_websocket_new(&attributes);
  if (handle_ <= 0) {
    handle_ = 0;
    emscripten_set_timeout([](void* user) { listener_of(user).socket_closed(kNoClosingCode, {}); },
                           0, &listener_);
    return;
  }
  // A failure is told as an error and then as a close; the close says all that there is to know.
  emscripten_websocket_set_onopen_callback(handle_, &listener_, on_open);
  emscripten_websocket_set_onmessage_callback(handle_, &listener_, on_message);
  emscripten_websocket_set_onclose_callback(handle_, &listener_, on_close);
}

void Socket::send(std::string_view text) {
  unsigned short state = 0;
  if (handle_ == 0 || emscripten_websocket_get_ready_state(handle_, &state) != 0 || state != kOpen)
    return;
  emscripten_websocket_send_utf8_text(handle_, std::string(text).c_str());
}

void Socket::close() {
  if (handle_ == 0) return;
  emscripten_websocket_close(handle_, kNormal, nullptr);
  emscripten_websocket_delete(handle_);  // takes the listeners away before the close is told
  handle_ = 0;
}

}  // namespace earthwork::viewer
