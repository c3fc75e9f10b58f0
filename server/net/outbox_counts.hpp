/// What was taken from an outbox, for the server's meters.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "server/net/websocket_frame.hpp"

namespace earthwork::net {

/// Bytes are those of the messages, without what the WebSocket adds.
struct OutboxCounts {
  std::uint64_t frames = 0, frame_bytes = 0;      ///< Binary messages.
  std::uint64_t controls = 0, control_bytes = 0;  ///< Text messages.

  void add(Kind kind, std::uint64_t bytes) {
    (kind == Kind::binary ? frames : controls) += 1;
    (kind == Kind::binary ? frame_bytes : control_bytes) += bytes;
  }
  void add(const OutboxCounts& other) {
    frames += other.frames, frame_bytes += other.frame_bytes;
    controls += other.controls, control_bytes += other.control_bytes;
  }
};

inline void append_counted(std::string& out, OutboxCounts& counts, Kind kind,
                           std::string_view payload) {
  append_message(out, kind, payload);
  counts.add(kind, payload.size());
}

}  // namespace earthwork::net
