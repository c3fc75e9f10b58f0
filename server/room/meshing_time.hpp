/// Counts the meshing of some chunks: how many, and for how long.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "server/room/meters.hpp"

namespace earthwork::room {

/// From here to the end of its scope. Each on its own thread.
class MeshingTime {
 public:
  MeshingTime(Meters& meters, std::size_t chunks)
      : meters_(meters), chunks_(chunks), start_(std::chrono::steady_clock::now()) {}
  MeshingTime(const MeshingTime&) = delete;
  MeshingTime& operator=(const MeshingTime&) = delete;
  ~MeshingTime() {
    const auto took = std::chrono::steady_clock::now() - start_;
    meters_.meshed_chunks += chunks_;
    meters_.mesh_ns += static_cast<std::uint64_t>(
        std::chrono::duration_cast<std::chrono::nanoseconds>(took).count());
  }

 private:
  Meters& meters_;
  const std::size_t chunks_;
  const std::chrono::steady_clock::time_point start_;
};

}  // namespace earthwork::room
