/// The edge between work that may throw and threads that must not: those of clerks.
#pragma once

#include <exception>

#include "protocol/result.hpp"

namespace earthwork::room {

/// What `work` gives, a Result; `internal` when it throws, out of memory most likely.
template <class Work>
[[nodiscard]] auto caught(const Work& work) -> decltype(work()) {
  try {
    return work();
  } catch (const std::exception& error) {
    return protocol::fail(protocol::Code::internal, error.what());
  }
}

}  // namespace earthwork::room
