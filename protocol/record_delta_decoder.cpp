// decode_delta and apply_delta: protocol/README.md, "Delta record", is the specification.
#include <algorithm>
#include <optional>
#include <string>

#include "protocol/byte_reader.hpp"
#include "protocol/byte_writer.hpp"
#include "protocol/limits.hpp"
#include "protocol/record_delta.hpp"
#include "protocol/record_delta_format.hpp"
#include "protocol/record_delta_triangles.hpp"
#include "protocol/record_format.hpp"

namespace earthwork::protocol {
namespace {

/// A normal is rounded from length 32767, so its own length is within one of that.
bool is_unit(MeshNormal normal) {
  const std::int64_t squared =
      std::int64_t{normal.x} * normal.x + std::int64_t{normal.y} * normal.y;
  return squared >= 32766ll * 32766 && squared <= 32768ll * 32768;
}

class Delta {
 public:
  Delta(const ChunkMesh& base, std::string_view operations)
      : base_(base), in_(std::as_bytes(std::span(operations.data(), operations.size()))) {}

  Result<ChunkMesh> apply() {
    if (!std::is_sorted(base_.vertices.begin(), base_.vertices.end(), precedes))
      refuse("base", "has vertices out of order");
    if (good()) read_sections();
    if (good()) read_vertices();
    if (good()) put_vertices();
    if (good()) {
      auto read = read_triangles(in_, base_, number_, mesh_);
      if (!read) failure_ = std::move(read.error());
    }
    if (good() && in_.remaining() > 0) refuse("delta", "holds bytes after its end");
    if (!failure_ && in_.failed())
      failure_ = frame_failure("delta", "ends early, or has a bad varint");
    if (failure_) return tl::unexpected<Failure>(std::move(*failure_));
    return std::move(mesh_);
  }

 private:
  struct Copy {
    std::size_t first = 0, count = 0;
  };

  // The sections: pieces that are new, each followed by a piece of the base.

  void read_sections() {
    const std::size_t count = in_.varint();
    if (count > base_.sections.size() + in_.remaining())
      return refuse("sections", "are more than the base and the delta hold");
    kept_.assign(base_.vertices.size(), 0);
    sections_.reserve(count);
    std::size_t copied = 0;
    Copy copy;
    while (good() && sections_.size() < count) {
      const std::size_t added = in_.varint();
      const std::size_t expected = copy.first + copy.count;
      copy = read_copy(expected);
      copied += copy.count;
      const std::size_t left = count - sections_.size();
      if (added > left || copy.count > left - added || added + copy.count == 0 ||
          copied > base_.sections.size())
        return refuse("sections", "are not as many as was said");
      for (std::size_t i = 0; i < added && good(); ++i) read_section(copy);
      if (good()) copy_sections(copy);
    }
  }

  Copy read_copy(std::size_t expected) {
    const std::size_t count = in_.varint();
    if (count == 0) return {expected, 0};
    const std::int64_t first = static_cast<std::int64_t>(expected) + unzigzag(in_.varint());
    const auto size = static_cast<std::int64_t>(base_.sections.size());
    if (first < 0 || first > size || static_cast<std::int64_t>(count) > size - first) {
      refuse("sections", "are copied from beyond the base");
      return {};
    }
    return {static_cast<std::size_t>(first), count};
  }

  void copy_sections(const Copy& copy) {
    for (std::size_t i = copy.first; i < copy.first + copy.count; ++i) {
      const WallSection& section = base_.sections[i];
      kept_[section.a] = kept_[section.b] = 1;
      sections_.push_back({section.a, section.b, section.normal_a, section.normal_b});
    }
    if (copy.count > 0) end_ = end_after(sections_.back());
  }

  WallEnd end_after(const OpenSection& section) const {
    return end_of(point(section.a), point(section.b), section.normal_a, section.normal_b);
  }

  void read_section(const Copy& copy) {
    const std::uint32_t head = in_.varint();
    const auto start_normal = static_cast<StartNormal>(head >> 3 & 3);
    const auto end_normal = static_cast<EndNormal>(head >> 5 & 3);
    const bool given = head & 1;
    if (head >= kSectionHeadEnd || start_normal > StartNormal::next_copy ||
        end_normal > EndNormal::next_copy || (!given && sections_.empty()) ||
        (given && start_normal == StartNormal::goes_on))
      return refuse("sections", "one starts nowhere, or has no head");
    OpenSection section;
    section.a = given ? read_reference() : sections_.back().b;
    if (!good()) return;
    const WallEnd from = given ? WallEnd{.at = point(section.a), .normal = {}, .bend = {}} : end_;
    const auto end = static_cast<SectionEnd>(head >> 1 & 3);
    section.b = end != SectionEnd::known ? read_end(from, end, start_normal != StartNormal::goes_on)
                : head & kEndIsGiven     ? read_reference()
                                         : copied(copy).a;
    if (!good()) return;
    const MeshPoint a = point(section.a), b = point(section.b);
    if (a == b) return refuse("sections", "one ends where it starts");
    section.normal_a = start_normal == StartNormal::goes_on ? end_.normal
                       : start_normal == StartNormal::coded ? read_normal(straight_normal(a, b))
                                                            : copied(copy).normal_a;
    if (!good()) return;
    section.normal_b = end_normal == EndNormal::same ? section.normal_a
                       : end_normal == EndNormal::coded
                           ? read_normal(round_normal(a, b, section.normal_a))
                           : copied(copy).normal_a;
    if (!good()) return;
    sections_.push_back(section);
    end_ = end_after(section);
  }

  /// The first section of the next copied piece.
  WallSection copied(const Copy& copy) {
    if (copy.count > 0) return base_.sections[copy.first];
    refuse("sections", "one joins a copied one that is not there");
    return {};
  }

  std::uint32_t read_reference() {
    const std::uint32_t bits = in_.varint(), value = bits >> kReferenceBits;
    switch (static_cast<Reference>(bits & 3)) {
      case Reference::base:
        last_base_ += unzigzag(value);
        if (last_base_ < 0 || last_base_ >= static_cast<std::int64_t>(base_.vertices.size())) break;
        kept_[static_cast<std::size_t>(last_base_)] = 1;
        return static_cast<std::uint32_t>(last_base_);
      case Reference::added:
        if (value >= added_.size()) break;
        return kFirstAdded + value;
      case Reference::position:
        return add_vertex(value, in_.varint());
    }
    refuse("sections", "one names a vertex that is not there");
    return 0;
  }

  std::uint32_t read_end(const WallEnd& from, SectionEnd kind, bool creased) {
    if (kind == SectionEnd::beside) {
      const bool by_x = runs_along_x(from.normal);
      const std::int32_t ahead = unzigzag(in_.varint());
      const std::int32_t guess = creased ? 0 : guess_beside(from, by_x, ahead);
      const std::int64_t beside = std::int64_t{guess} + unzigzag(in_.varint());
      return add_vertex(from.at.x + (by_x ? ahead : beside), from.at.y + (by_x ? beside : ahead));
    }
    const GridLine line = kind == SectionEnd::on_row ? GridLine::row : GridLine::column;
    const std::uint32_t bits = in_.varint();
    const std::int32_t position = line_beside(from, line, bits & 1);
    const std::int32_t stays = line == GridLine::row ? from.at.x : from.at.y;
    const std::int64_t along =
        std::int64_t{creased ? stays : guess_on_line(from, line, position)} + unzigzag(bits >> 1);
    return line == GridLine::row ? add_vertex(along, position) : add_vertex(position, along);
  }

  std::uint32_t add_vertex(std::int64_t x, std::int64_t y) {
    if (x < 0 || x >= kMeshCoordinateEnd || y < 0 || y >= kMeshCoordinateEnd) {
      refuse("vertices", "a coordinate is outside the chunk");
    } else {
      added_.push_back({static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)});
      if (added_.size() > kMaxVertices)
        refuse("vertices", "are beyond the limit of " + std::to_string(kMaxVertices));
    }
    return kFirstAdded + static_cast<std::uint32_t>(added_.size() - 1);
  }

  MeshNormal read_normal(MeshNormal guess) {
    const std::uint8_t steps = in_.u8();
    MeshNormal normal;
    if (steps == kNormalFollows) {
      normal.x = in_.i16();
      normal.y = in_.i16();
    } else {
      normal.x = static_cast<std::int16_t>(guess.x + unzigzag(steps >> 4));
      normal.y = static_cast<std::int16_t>(guess.y + unzigzag(steps & 15));
    }
    if (steps > kNormalFollows || !is_unit(normal))
      refuse("sections", "a normal's length is not 32767");
    return normal;
  }

  MeshPoint point(std::uint32_t vertex) const {
    return vertex < kFirstAdded ? base_.vertices[vertex] : added_[vertex - kFirstAdded];
  }

  // The vertices: what sections of the base stood on goes unless a section stands on it.

  void read_vertices() {
    std::vector<std::uint8_t> walled(base_.vertices.size(), 0);
    for (const WallSection& section : base_.sections) walled[section.a] = walled[section.b] = 1;
    for (std::size_t i = 0; i < kept_.size(); ++i) kept_[i] |= walled[i] ^ 1;
    std::size_t next = 0;
    for (std::uint32_t left = in_.varint(); left > 0 && good(); --left) {
      next += in_.varint();
      if (next >= kept_.size()) return refuse("vertices", "one is beyond those of the base");
      kept_[next++] ^= 1;
    }
    for (std::uint32_t left = in_.varint(); left > 0 && good(); --left) {
      const std::uint32_t x = in_.varint();
      add_vertex(x, in_.varint());
    }
  }

  void put_vertices() {
    std::vector<std::uint32_t> order(added_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t i, std::uint32_t j) { return precedes(added_[i], added_[j]); });
    number_.assign(base_.vertices.size(), kNoVertex);
    added_number_.assign(added_.size(), kNoVertex);
    mesh_.vertices.reserve(base_.vertices.size() + added_.size());
    auto next = order.begin();
    const auto put = [&](MeshPoint vertex, std::uint32_t& number) {
      number = static_cast<std::uint32_t>(mesh_.vertices.size());
      mesh_.vertices.push_back(vertex);
    };
    for (std::size_t i = 0; i < base_.vertices.size(); ++i) {
      if (!kept_[i]) continue;
      for (; next != order.end() && precedes(added_[*next], base_.vertices[i]); ++next)
        put(added_[*next], added_number_[*next]);
      put(base_.vertices[i], number_[i]);
    }
    for (; next != order.end(); ++next) put(added_[*next], added_number_[*next]);
    check_order();
    if (good()) put_sections();
  }

  void check_order() {
    const auto& vertices = mesh_.vertices;
    if (vertices.size() > kMaxVertices)
      return refuse("vertices", "are beyond the limit of " + std::to_string(kMaxVertices));
    for (std::size_t i = 1; i < vertices.size(); ++i)
      if (!precedes(vertices[i - 1], vertices[i])) return refuse("vertices", "one is there twice");
  }

  void put_sections() {
    mesh_.sections.reserve(sections_.size());
    for (const OpenSection& section : sections_) {
      const std::uint32_t a = number(section.a), b = number(section.b);
      if (a == kNoVertex || b == kNoVertex)
        return refuse("sections", "one stands on a vertex that is gone");
      mesh_.sections.push_back({static_cast<std::uint16_t>(a), static_cast<std::uint16_t>(b),
                                section.normal_a, section.normal_b});
    }
  }

  std::uint32_t number(std::uint32_t vertex) const {
    return vertex < kFirstAdded ? number_[vertex] : added_number_[vertex - kFirstAdded];
  }

  bool good() const { return !failure_ && !in_.failed(); }
  /// What comes of zeros read past the end is not said.
  void refuse(const char* field, const std::string& sentence) {
    if (good()) failure_ = frame_failure(field, sentence);
  }

  const ChunkMesh& base_;
  ByteReader in_;
  std::vector<std::uint8_t> kept_;  // of the base's vertices
  std::vector<MeshPoint> added_;    // new vertices in the order of the bytes
  std::vector<OpenSection> sections_;
  WallEnd end_;                                       // after the last section
  std::int64_t last_base_ = 0;                        // the base vertex named last
  std::vector<std::uint32_t> number_, added_number_;  // in the new mesh
  ChunkMesh mesh_;
  std::optional<Failure> failure_;
};

tl::unexpected<Failure> refuse(const char* field, const std::string& sentence) {
  return tl::unexpected<Failure>(frame_failure(field, sentence));
}

}  // namespace

bool is_delta(std::span<const std::byte> bytes) {
  return bytes.size() > kRecordLengthBytes &&
         std::to_integer<std::uint8_t>(bytes[kRecordLengthBytes]) == kRecordDelta;
}

Result<ChunkDelta> decode_delta(std::span<const std::byte> bytes) {
  ByteReader in(bytes);
  if (in.u32() != bytes.size() - kRecordLengthBytes ||
      bytes.size() > kRecordLengthBytes + kMaxRecordBytes)
    return refuse("length", "is not that of the record, or beyond the limit");
  if (in.u8() != kRecordDelta) return refuse("kind", "is not 3");
  ChunkDelta delta;
  delta.key.layer = in.u8();
  delta.key.x = in.i32();
  delta.key.y = in.i32();
  delta.key.z = in.i32();
  delta.revision = in.u64();
  const std::uint32_t back = in.varint();
  if (in.failed()) return refuse("record", "ends early, or holds a varint that is none");
  if (auto key = check_key(delta.key); !key) return tl::unexpected<Failure>(std::move(key.error()));
  if (back == 0 || back > delta.revision)
    return refuse("base revision", "is not before the revision");
  delta.base_revision = delta.revision - back;
  const auto rest = bytes.last(in.remaining());
  delta.operations.assign(reinterpret_cast<const char*>(rest.data()), rest.size());
  return delta;
}

Result<ChunkRecord> apply_delta(const ChunkMesh& base, const ChunkDelta& delta) {
  auto mesh = Delta(base, delta.operations).apply();
  if (!mesh) return tl::unexpected<Failure>(std::move(mesh.error()));
  return ChunkRecord{
      .key = delta.key, .revision = delta.revision, .removed = false, .mesh = std::move(*mesh)};
}

}  // namespace earthwork::protocol
