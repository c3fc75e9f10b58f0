/// One WebSocket: a reader, a writer and a watch over the time, around a conversation.
#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <string>

#include "server/net/connections.hpp"
#include "server/net/service.hpp"

namespace earthwork::net {

inline constexpr const char* kSubprotocol = "earthwork.v1";

/// Answers the upgrade and runs the session to its end; `socket` is on a strand, and closed then.
/// `handshake` is the request as it was read: it offers the subprotocol, and may come here at all.
boost::asio::awaitable<void> run_session(boost::asio::ip::tcp::socket socket, std::string handshake,
                                         Service service, Connections::Id connection);

}  // namespace earthwork::net
