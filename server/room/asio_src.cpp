// Asio's functions, compiled once for all of the server.
#include <boost/asio/impl/src.hpp>
