/// The mesh of one chunk as it travels: fixed-point integers, exact to stored precision.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/result.hpp"

namespace earthwork::protocol {

/// Ordered by layer, then x, y, z; counted in chunks; z is 0 in a 2D map.
struct ChunkKey {
  std::int32_t layer = 0, x = 0, y = 0, z = 0;
  friend auto operator<=>(const ChunkKey&, const ChunkKey&) = default;
};

/// 1/32768 voxel from the chunk's origin (its lower-left corner; voxel i's centre lies at
/// (i + 0.5) * 32768). 0 .. 65 * 32768 - 1 at resolution 64, which takes 22 bits.
struct MeshPoint {
  std::int32_t x = 0, y = 0;
  friend bool operator==(const MeshPoint&, const MeshPoint&) = default;
};
/// 32767 times a unit vector in the plane.
struct MeshNormal {
  std::int16_t x = 0, y = 0;
  friend bool operator==(const MeshNormal&, const MeshNormal&) = default;
};
/// A wall from vertex a to vertex b, filled ground on the left of a -> b, facing right.
struct WallSection {
  std::uint16_t a = 0, b = 0;
  MeshNormal normal_a, normal_b;
  friend bool operator==(const WallSection&, const WallSection&) = default;
};
/// Three vertex indices a triangle, counter-clockwise seen from above. At most 65,535 vertices.
struct ChunkMesh {
  std::vector<MeshPoint> vertices;
  std::vector<std::uint16_t> triangles;
  std::vector<WallSection> sections;
  friend bool operator==(const ChunkMesh&, const ChunkMesh&) = default;
};

/// A chunk's whole mesh, or word that it has none any more (`removed`; the mesh is then empty).
struct ChunkRecord {
  ChunkKey key;
  std::uint64_t revision = 0;  ///< The seq as of which this mesh was made.
  bool removed = false;
  ChunkMesh mesh;
  friend bool operator==(const ChunkRecord&, const ChunkRecord&) = default;
};

/// Appends the record's bytes, its u32 length first (protocol/README.md: "Chunk record").
/// The mesh must keep the promises above.
void encode_record(const ChunkRecord& record, std::string& out);

/// Decodes one record that fills `bytes` (length field included). Every count and index is
/// checked before memory is taken; bad_frame says which field.
[[nodiscard]] Result<ChunkRecord> decode_record(std::span<const std::byte> bytes);

/// The chunk's part of a mesh hash (GEOMETRY "Hashes"): XXH3-64 over twice the area and the
/// sections in order.
[[nodiscard]] std::uint64_t mesh_hash(const ChunkMesh& mesh);
/// What the chunk adds to the map's mesh hash: XXH3-64 over the key and `chunk_hash`. The map's is
/// the sum modulo 2^64 over chunks that have a mesh.
[[nodiscard]] std::uint64_t mesh_hash_term(const ChunkKey& key, std::uint64_t chunk_hash);
/// Twice the surface's area in squared position units.
[[nodiscard]] std::uint64_t twice_area(const ChunkMesh& mesh);
/// 16 hex digits, lower case.
[[nodiscard]] std::string hex(std::uint64_t value);
/// The value of exactly 16 lower-case hex digits.
[[nodiscard]] Result<std::uint64_t> parse_hex(std::string_view digits);

}  // namespace earthwork::protocol
