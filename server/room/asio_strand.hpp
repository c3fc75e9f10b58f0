/// The strand of a running server: an Asio strand on its thread pool.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <memory>

#include "server/room/strand.hpp"

namespace earthwork::room {

/// A new strand on `executor`, whose context must outlive it.
[[nodiscard]] std::unique_ptr<Strand> make_asio_strand(
    const boost::asio::any_io_executor& executor);
/// The same over an executor that already runs one task at a time, such as a session's. What is
/// posted aside runs there too: it knows no other.
[[nodiscard]] std::unique_ptr<Strand> wrap_serial_executor(
    const boost::asio::any_io_executor& executor);

}  // namespace earthwork::room
