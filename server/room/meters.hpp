/// What a server counts, of all its maps and sessions together.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "protocol/result.hpp"

namespace earthwork::room {

/// Any thread; each number stands for itself, and only `sessions` and `waiting_events` ever fall.
struct Meters {
  using Count = std::atomic<std::uint64_t>;

  Count edits{0};                       ///< Accepted: they have numbers.
  Count repeated{0};                    ///< Answered from memory, for they had been sent before.
  Count chat_lines{0};                  ///< Said.
  Count meshed_chunks{0};               ///< Meshes made, the unchanged ones too,
  Count mesh_ns{0};                     ///< and how long it took, all threads added up.
  Count frames{0}, frame_bytes{0};      ///< Binary messages written to sockets.
  Count controls{0}, control_bytes{0};  ///< Text messages.
  std::atomic<std::int64_t> sessions{0};

  // Of journals, counted by the rooms that hand their events to them. With a journal in memory too.
  Count commits{0};           ///< Batches that became durable,
  Count committed_events{0};  ///< the events in them,
  Count commit_ns{0};  ///< and how long each took from when it was handed over, all added up.
  std::atomic<std::int64_t> waiting_events{0};  ///< Accepted; neither durable nor taken back yet.
  Count keyframes{0};                           ///< That were put.

  /// Refusals, by their code.
  std::array<Count, static_cast<std::size_t>(protocol::Code::internal) + 1> rejected{};
  /// What journals failed with: a batch, a keyframe, a map that could not be made, opened or
  /// removed. By their code.
  std::array<Count, static_cast<std::size_t>(protocol::Code::internal) + 1> journal_failures{};
};

}  // namespace earthwork::room
