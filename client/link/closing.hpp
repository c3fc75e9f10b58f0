/// How a connection to a server ends.
#pragma once

#include "protocol/result.hpp"

namespace earthwork::link {

enum class CloseCause {
  asked,        ///< By its owner.
  unreachable,  ///< No connection, or what answered does not speak the protocol.
  refused,      ///< The server refused the hello or the join.
  lost,         ///< The connection broke, the server said bye, or sent what is no message.
};

struct Closing {
  CloseCause cause = CloseCause::asked;
  protocol::Failure failure;  ///< For people, naming the server; empty when asked.
};

}  // namespace earthwork::link
