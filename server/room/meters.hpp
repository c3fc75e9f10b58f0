/// What a server counts, of all its maps and sessions together.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "protocol/result.hpp"

namespace earthwork::room {

/// Any thread; each number stands for itself, and only `sessions` ever falls.
struct Meters {
  using Count = std::atomic<std::uint64_t>;

  Count edits{0};                       ///< Accepted: they have numbers.
  Count repeated{0};                    ///< Answered from memory, for they had been sent before.
  Count meshed_chunks{0};               ///< Meshes made, the unchanged ones too,
  Count mesh_ns{0};                     ///< and how long it took, all threads added up.
  Count frames{0}, frame_bytes{0};      ///< Binary messages written to sockets.
  Count controls{0}, control_bytes{0};  ///< Text messages.
  std::atomic<std::int64_t> sessions{0};

  /// Refusals, by their code.
  std::array<Count, static_cast<std::size_t>(protocol::Code::internal) + 1> rejected{};
};

}  // namespace earthwork::room
