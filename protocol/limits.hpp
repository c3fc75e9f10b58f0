/// The bounds on everything that arrives. Each is checked where bytes become values, and each has
/// a test at it and one past it.
#pragma once

#include <cstddef>
#include <cstdint>

namespace earthwork::protocol {

inline constexpr int kProtocolVersion = 1;        ///< Of the control messages.
inline constexpr std::uint8_t kFrameVersion = 1;  ///< First byte of every binary message.

inline constexpr std::size_t kMaxControlBytes = 64 * 1024;                ///< From a client.
inline constexpr std::size_t kMaxServerControlBytes = 1024 * 1024;        ///< From a server.
inline constexpr std::int64_t kMaxInteger = (std::int64_t{1} << 53) - 1;  ///< Ids, sequences.
inline constexpr int kMaxJsonDepth = 16;
inline constexpr double kMaxRadiusVoxels = 512;
inline constexpr double kMaxCoordinateVoxels = 1e6;
inline constexpr std::size_t kMaxPathPoints = 1024;
inline constexpr std::uint64_t kMaxEditVisits = std::uint64_t{1}
                                                << 24;  ///< Voxels, stamps added up.
inline constexpr std::uint64_t kMaxEditChunks = 4096;
inline constexpr std::uint64_t kMaxViewChunks = 16384;
/// Where a map without bounds ends, in voxels from 0: past all that a stencil of the largest radius
/// can reach from the furthest centre, and a whole number of chunks of any size.
inline constexpr std::int32_t kWorldVoxels = 1'000'576;
inline constexpr std::int32_t kMaxChunkCoordinate = kWorldVoxels / 8;
inline constexpr double kMaxHeight = 1e6;              ///< Of a wall's ends, map units.
inline constexpr std::size_t kMaxNameBytes = 64;       ///< Of a map.
inline constexpr std::size_t kMaxNameCharacters = 64;  ///< Of a person or a layer.
inline constexpr std::size_t kMaxLayers = 16;
inline constexpr std::size_t kMaxChatCharacters = 500;  ///< Of one line.
inline constexpr std::size_t kMaxChatLines = 8;         ///< Of one session in kChatSeconds.
inline constexpr int kChatSeconds = 10;
inline constexpr std::size_t kKeptChatLines = 100;  ///< Of a map, for who joins.

inline constexpr std::size_t kMaxFrameBytes = 16 * 1024;     ///< A binary message.
inline constexpr std::size_t kMaxRecordBytes = 1024 * 1024;  ///< A chunk record, across messages.
inline constexpr std::size_t kMaxVertices = 65535;           ///< Of a chunk's mesh.
/// Mesh coordinates end before this: 65 voxels in 1/32768.
inline constexpr std::int32_t kMeshCoordinateEnd = 65 * 32768;

/// Of an author's last ids in a map, to know one that is sent again.
inline constexpr std::size_t kMaxRememberedIds = 4096;
inline constexpr std::int64_t kMaxWaitMs = 3'600'000;  ///< In a script.

}  // namespace earthwork::protocol
