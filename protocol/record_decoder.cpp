// decode_record: bytes from anybody become a mesh that keeps every promise of ChunkMesh which can
// be seen without geometry: counts, coordinates, indices and normals.
#include <optional>
#include <string>

#include "protocol/byte_reader.hpp"
#include "protocol/byte_writer.hpp"
#include "protocol/chunk_record.hpp"
#include "protocol/limits.hpp"
#include "protocol/record_format.hpp"

namespace earthwork::protocol {
namespace {

/// A normal is rounded from length 32767, so its own length is within one of that.
constexpr std::int64_t kMinNormalSquared = 32766ll * 32766, kMaxNormalSquared = 32768ll * 32768;

class Decoder {
 public:
  explicit Decoder(std::span<const std::byte> bytes) : size_(bytes.size()), in_(bytes) {}

  Result<ChunkRecord> decode() {
    read_head();
    if (good() && !record_.removed) read_mesh();
    if (in_.failed()) refuse("record", "ends early, or holds a varint that is none");
    if (in_.remaining() > 0) refuse("record", "holds bytes after its end");
    if (!good()) return tl::unexpected<Failure>(std::move(*failure_));
    return std::move(record_);
  }

 private:
  void read_head() {
    if (in_.u32() != size_ - kRecordLengthBytes || size_ > kRecordLengthBytes + kMaxRecordBytes)
      return refuse("length", "is not that of the record, or beyond the limit");
    const std::uint8_t kind = in_.u8();
    if (kind != kRecordFull && kind != kRecordRemoved) return refuse("kind", "is not 1 or 2");
    record_.removed = kind == kRecordRemoved;
    record_.key.layer = in_.u8();
    record_.key.x = in_.i32();
    record_.key.y = in_.i32();
    record_.key.z = in_.i32();
    record_.revision = in_.u64();
    if (auto key = check_key(record_.key); !key && good()) failure_ = std::move(key.error());
  }

  void read_mesh() {
    const std::size_t vertices = in_.varint(), triangles = in_.varint(), sections = in_.varint();
    if (vertices > kMaxVertices)
      return refuse("vertices", "are beyond the limit of " + std::to_string(kMaxVertices));
    // What the counts need at least, before memory is taken for them. No sum overflows 64 bits.
    const std::uint64_t least =
        std::uint64_t{vertices} * 2 + std::uint64_t{triangles} * 3 + sections;
    if (in_.failed() || least > in_.remaining())
      return refuse("counts", "ask for more than the record holds");
    read_coordinates(vertices);
    if (good()) read_triangles(triangles);
    if (good()) read_sections(sections);
  }

  void read_coordinates(std::size_t count) {
    record_.mesh.vertices.resize(count);
    read_column(&MeshPoint::x);
    read_column(&MeshPoint::y);
  }

  void read_column(std::int32_t MeshPoint::*axis) {
    std::int64_t value = 0;
    for (MeshPoint& vertex : record_.mesh.vertices) {
      value += unzigzag(in_.varint());
      if (value < 0 || value >= kMeshCoordinateEnd)
        return refuse("vertices", "a coordinate is outside the chunk");
      vertex.*axis = static_cast<std::int32_t>(value);
    }
  }

  void read_triangles(std::size_t count) {
    const auto vertices = static_cast<std::int64_t>(record_.mesh.vertices.size());
    auto& indices = record_.mesh.triangles;
    indices.resize(count * 3);
    std::int64_t value = 0;
    for (std::uint16_t& index : indices) {
      value += unzigzag(in_.varint());
      if (value < 0 || value >= vertices)
        return refuse("triangles", "an index is beyond the vertices");
      index = static_cast<std::uint16_t>(value);
    }
    for (std::size_t i = 0; i < indices.size(); i += 3)
      if (indices[i] == indices[i + 1] || indices[i + 1] == indices[i + 2] ||
          indices[i + 2] == indices[i])
        return refuse("triangles", "a triangle names a vertex twice");
  }

  void read_sections(std::size_t count) {
    record_.mesh.sections.reserve(count);
    while (good() && record_.mesh.sections.size() < count)
      read_chain(count - record_.mesh.sections.size());
  }

  void read_chain(std::size_t most) {
    const std::size_t length = in_.varint(), start = in_.varint();
    if (length < 1 || length > most)
      return refuse("sections", "a chain's length is 0 or beyond the count of sections");
    if (start >= record_.mesh.vertices.size())
      return refuse("sections", "a chain starts beyond the vertices");
    std::int64_t at = static_cast<std::int64_t>(start);
    for (std::size_t i = 0; i < length && good(); ++i) at = read_section(at, i == 0);
  }

  /// Gives back the vertex where the section ends.
  std::int64_t read_section(std::int64_t from, bool first) {
    const std::uint32_t bits = in_.varint();
    const std::int64_t to = from + unzigzag(bits >> kSectionFlagBits);
    const bool own_start = bits & kStartNormalFollows;
    if (to < 0 || to >= static_cast<std::int64_t>(record_.mesh.vertices.size()) || to == from) {
      refuse("sections", "a section ends beyond the vertices, or where it starts");
    } else if (first && !own_start) {
      refuse("sections", "a chain has no normal at its start");
    } else {
      const MeshNormal start = own_start ? read_normal() : record_.mesh.sections.back().normal_b;
      const MeshNormal end = bits & kEndNormalFollows ? read_normal() : start;
      record_.mesh.sections.push_back(
          {static_cast<std::uint16_t>(from), static_cast<std::uint16_t>(to), start, end});
    }
    return to;
  }

  MeshNormal read_normal() {
    MeshNormal normal;
    normal.x = in_.i16();
    normal.y = in_.i16();
    const std::int64_t squared =
        std::int64_t{normal.x} * normal.x + std::int64_t{normal.y} * normal.y;
    if (squared < kMinNormalSquared || squared > kMaxNormalSquared)
      refuse("sections", "a normal's length is not 32767");
    return normal;
  }

  bool good() const { return !failure_ && !in_.failed(); }
  void refuse(const char* field, const std::string& sentence) {
    if (failure_) return;
    failure_ = Failure{Code::bad_frame, std::string(field) + ": " + sentence, field};
  }

  std::size_t size_;
  ByteReader in_;
  ChunkRecord record_;
  std::optional<Failure> failure_;
};

}  // namespace

Result<void> check_key(const ChunkKey& key) {
  if (key.layer >= static_cast<std::int32_t>(kMaxLayers))
    return fail(Code::bad_frame, "layer: is beyond the limit of " + std::to_string(kMaxLayers - 1),
                "layer");
  for (const std::int32_t at : {key.x, key.y, key.z})
    if (at < -kMaxChunkCoordinate || at > kMaxChunkCoordinate)
      return fail(Code::bad_frame,
                  "key: is beyond the limit of " + std::to_string(kMaxChunkCoordinate), "key");
  return {};
}

Result<ChunkRecord> decode_record(std::span<const std::byte> bytes) {
  return Decoder(bytes).decode();
}

}  // namespace earthwork::protocol
