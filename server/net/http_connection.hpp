/// One connection: HTTP requests one after the other, until one of them becomes a WebSocket.
#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "server/net/connections.hpp"
#include "server/net/service.hpp"

namespace earthwork::net {

/// What becomes of a connection.
enum class Reception {
  served,
  turned_away,  ///< With 503, whatever it asks for: the server has too many.
};

/// Runs the connection, listed under `id`, to its end, and takes it off the list; `socket` is on a
/// strand. Does not throw.
boost::asio::awaitable<void> serve_connection(boost::asio::ip::tcp::socket socket, Service service,
                                              Connections::Id id, Reception reception);

}  // namespace earthwork::net
