/// One WebSocket: a reader, a writer and a watch over the time, around a conversation.
#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>

#include "server/net/connections.hpp"
#include "server/net/service.hpp"
#include "server/net/stream.hpp"

namespace earthwork::net {

/// Answers the upgrade and runs the session to its end; `stream` is on a strand, and closed then.
/// The request offers the subprotocol, and may come here at all.
boost::asio::awaitable<void> run_session(
    Stream stream, boost::beast::http::request<boost::beast::http::string_body> request,
    Service service, Connections::Id connection);

inline constexpr const char* kSubprotocol = "earthwork.v1";

}  // namespace earthwork::net
