// encode_delta: protocol/README.md, "Delta record", is the specification.
#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

#include "protocol/byte_appender.hpp"
#include "protocol/byte_writer.hpp"
#include "protocol/limits.hpp"
#include "protocol/record_delta.hpp"
#include "protocol/record_delta_format.hpp"
#include "protocol/record_delta_triangles.hpp"
#include "protocol/record_format.hpp"

namespace earthwork::protocol {
namespace {

constexpr std::uint32_t kNone = kNoVertex;

bool in_order(const std::vector<MeshPoint>& vertices) {
  for (std::size_t i = 1; i < vertices.size(); ++i)
    if (!precedes(vertices[i - 1], vertices[i])) return false;
  return true;
}

/// Which vertices of two meshes are the same point.
struct Matching {
  std::vector<std::uint32_t> of_next;  // for a vertex of the next mesh that of the base, or kNone
  std::vector<std::uint32_t> of_base;  // and the other way round
};

Matching match(const std::vector<MeshPoint>& base, const std::vector<MeshPoint>& next) {
  Matching matching{.of_next = std::vector<std::uint32_t>(next.size(), kNone),
                    .of_base = std::vector<std::uint32_t>(base.size(), kNone)};
  for (std::size_t i = 0, j = 0; i < base.size() && j < next.size();) {
    if (base[i] == next[j]) {
      matching.of_base[i] = static_cast<std::uint32_t>(j);
      matching.of_next[j++] = static_cast<std::uint32_t>(i++);
    } else if (precedes(base[i], next[j])) {
      ++i;
    } else {
      ++j;
    }
  }
  return matching;
}

class Encoder {
 public:
  Encoder(const ChunkMesh& base, const ChunkMesh& next, std::string& out)
      : base_(base), next_(next), same_(match(base.vertices, next.vertices)), out_(out) {}

  void write() {
    plan_sections();
    write_sections();
    write_vertices();
    write_triangles(base_, next_, same_.of_base, out_);
  }

 private:
  /// New sections first .. first + added, then `copied` ones of the base from `from` on.
  struct Piece {
    std::size_t first = 0, added = 0, from = 0, copied = 0;
  };

  void plan_sections() {
    starting_.assign(base_.vertices.size(), kNone);
    for (std::size_t i = 0; i < base_.sections.size(); ++i)
      starting_[base_.sections[i].a] = static_cast<std::uint32_t>(i);
    std::vector<std::uint8_t> used(base_.sections.size(), 0);
    std::size_t expected = 0;
    bool copying = false;
    pieces_ = {Piece{}};
    for (std::size_t j = 0; j < next_.sections.size(); ++j) {
      const std::uint32_t i = same_section(next_.sections[j], expected);
      if (i == kNone || used[i]) {
        if (copying) pieces_.push_back({.first = j, .added = 0, .from = 0, .copied = 0});
        copying = false;
        ++pieces_.back().added;
        continue;
      }
      if (copying && i != expected)
        pieces_.push_back({.first = j, .added = 0, .from = 0, .copied = 0});
      if (pieces_.back().copied++ == 0) pieces_.back().from = i;
      used[i] = 1;
      copying = true;
      expected = i + 1;
    }
  }

  /// The section of the base that is this one, `expected` before all others; or kNone.
  std::uint32_t same_section(const WallSection& section, std::size_t expected) const {
    const std::uint32_t a = same_.of_next[section.a], b = same_.of_next[section.b];
    if (a == kNone || b == kNone) return kNone;
    const auto same = [&](const WallSection& other) {
      return other.a == a && other.b == b && other.normal_a == section.normal_a &&
             other.normal_b == section.normal_b;
    };
    if (expected < base_.sections.size() && same(base_.sections[expected]))
      return static_cast<std::uint32_t>(expected);
    const std::uint32_t found = starting_[a];
    return found != kNone && same(base_.sections[found]) ? found : kNone;
  }

  void write_sections() {
    kept_.assign(base_.vertices.size(), 0);
    added_.assign(next_.vertices.size(), kNone);
    out_.varint(static_cast<std::uint32_t>(next_.sections.size()));
    if (next_.sections.empty()) return;
    std::size_t expected = 0;
    for (const Piece& piece : pieces_) {
      out_.varint(static_cast<std::uint32_t>(piece.added));
      out_.varint(static_cast<std::uint32_t>(piece.copied));
      if (piece.copied > 0) {
        out_.step(static_cast<std::int64_t>(piece.from) - static_cast<std::int64_t>(expected));
        expected = piece.from + piece.copied;
      }
      for (std::size_t j = piece.first; j < piece.first + piece.added; ++j) {
        const bool last = j + 1 == piece.first + piece.added;
        write_section(j, last && piece.copied > 0 ? &base_.sections[piece.from] : nullptr);
      }
      for (std::size_t i = piece.from; i < piece.from + piece.copied; ++i)
        kept_[base_.sections[i].a] = kept_[base_.sections[i].b] = 1;
    }
  }

  /// `copied` is the section after it, if that is one of the base.
  void write_section(std::size_t j, const WallSection* copied) {
    const WallSection& section = next_.sections[j];
    const WallSection* before = j > 0 ? &next_.sections[j - 1] : nullptr;
    const bool given = !before || before->b != section.a;
    const bool joins = copied && same_.of_next[section.b] == copied->a;
    const auto start_normal = !given && section.normal_a == before->normal_b ? StartNormal::goes_on
                              : copied && section.normal_a == copied->normal_a
                                  ? StartNormal::next_copy
                                  : StartNormal::coded;
    const auto end_normal = section.normal_b == section.normal_a             ? EndNormal::same
                            : copied && section.normal_b == copied->normal_a ? EndNormal::next_copy
                                                                             : EndNormal::coded;
    const MeshPoint a = next_.vertices[section.a], b = next_.vertices[section.b];
    const bool added = is_new(section.b);
    WallEnd from{.at = a, .normal = {}, .bend = {}};
    if (!given) from = end_of(next_.vertices[before->a], a, before->normal_a, before->normal_b);
    Goal goal;
    if (added) goal = aim(from, b, start_normal != StartNormal::goes_on);
    const auto end = added ? goal.end : SectionEnd::known;
    out_.varint(static_cast<std::uint32_t>(given) | static_cast<std::uint32_t>(end) << 1 |
                static_cast<std::uint32_t>(start_normal) << 3 |
                static_cast<std::uint32_t>(end_normal) << 5 | (!added && !joins ? kEndIsGiven : 0));
    if (given) write_reference(section.a);
    if (added) {
      add(section.b);
      out_.varint(goal.first);
      if (end == SectionEnd::beside) out_.varint(goal.second);
    } else if (!joins) {
      write_reference(section.b);
    }
    if (start_normal == StartNormal::coded) write_normal(section.normal_a, straight_normal(a, b));
    if (end_normal == EndNormal::coded)
      write_normal(section.normal_b, round_normal(a, b, section.normal_a));
  }

  bool is_new(std::uint32_t vertex) const {
    return same_.of_next[vertex] == kNone && added_[vertex] == kNone;
  }
  void add(std::uint32_t vertex) { added_[vertex] = added_count_++; }

  void write_reference(std::uint32_t vertex) {
    const auto write = [&](Reference kind, std::uint32_t value) {
      out_.varint(value << kReferenceBits | static_cast<std::uint32_t>(kind));
    };
    const std::uint32_t base = same_.of_next[vertex];
    if (base != kNone) {
      kept_[base] = 1;
      write(Reference::base, zigzag(static_cast<std::int32_t>(base) - last_base_));
      last_base_ = static_cast<std::int32_t>(base);
    } else if (added_[vertex] != kNone) {
      write(Reference::added, added_[vertex]);
    } else {
      add(vertex);
      write(Reference::position, static_cast<std::uint32_t>(next_.vertices[vertex].x));
      out_.varint(static_cast<std::uint32_t>(next_.vertices[vertex].y));
    }
  }

  /// How a new vertex is said: the kind of end, and one varint or two.
  struct Goal {
    SectionEnd end = SectionEnd::beside;
    std::uint32_t first = 0, second = 0;
  };

  static Goal aim(const WallEnd& from, MeshPoint to, bool creased) {
    for (const GridLine line : {GridLine::row, GridLine::column}) {
      const bool row = line == GridLine::row;
      const std::int32_t stays = row ? from.at.x : from.at.y, along = row ? to.x : to.y;
      for (const bool behind : {false, true}) {
        const std::int32_t position = line_beside(from, line, behind);
        if ((row ? to.y : to.x) != position) continue;
        const std::int32_t guess = creased ? stays : guess_on_line(from, line, position);
        return {.end = row ? SectionEnd::on_row : SectionEnd::on_column,
                .first = zigzag(along - guess) << 1 | static_cast<std::uint32_t>(behind),
                .second = 0};
      }
    }
    const bool by_x = runs_along_x(from.normal);
    const std::int32_t dx = to.x - from.at.x, dy = to.y - from.at.y;
    const std::int32_t ahead = by_x ? dx : dy, beside = by_x ? dy : dx;
    const std::int32_t guess = creased ? 0 : guess_beside(from, by_x, ahead);
    return {.end = SectionEnd::beside, .first = zigzag(ahead), .second = zigzag(beside - guess)};
  }

  void write_normal(MeshNormal normal, MeshNormal guess) {
    const std::uint32_t x = zigzag(normal.x - guess.x), y = zigzag(normal.y - guess.y);
    if (x < kNormalStepEnd && y <= kNormalStepEnd) return out_.u8(x << 4 | y);
    out_.u8(kNormalFollows);
    out_.i16(normal.x);
    out_.i16(normal.y);
  }

  void write_vertices() {
    std::vector<std::uint8_t> walled(base_.vertices.size(), 0);
    for (const WallSection& section : base_.sections) walled[section.a] = walled[section.b] = 1;
    std::vector<std::uint32_t> otherwise;
    for (std::size_t i = 0; i < kept_.size(); ++i) {
      const bool kept = kept_[i] || !walled[i];
      if (kept != (same_.of_base[i] != kNone)) otherwise.push_back(static_cast<std::uint32_t>(i));
    }
    out_.varint(static_cast<std::uint32_t>(otherwise.size()));
    std::uint32_t next = 0;
    for (const std::uint32_t i : otherwise) {
      out_.varint(i - next);
      next = i + 1;
    }
    std::uint32_t left = 0;
    for (std::uint32_t j = 0; j < added_.size(); ++j) left += is_new(j);
    out_.varint(left);
    for (std::uint32_t j = 0; j < added_.size() && left > 0; ++j) {
      if (!is_new(j)) continue;
      out_.varint(static_cast<std::uint32_t>(next_.vertices[j].x));
      out_.varint(static_cast<std::uint32_t>(next_.vertices[j].y));
    }
  }

  const ChunkMesh& base_;
  const ChunkMesh& next_;
  Matching same_;
  ByteAppender out_;
  std::vector<std::uint32_t> starting_;  // the section of the base that starts at a vertex
  std::vector<Piece> pieces_;
  std::vector<std::uint8_t> kept_;    // vertices of the base that a section stands on again
  std::vector<std::uint32_t> added_;  // the number of a new vertex among the new ones, or kNone
  std::uint32_t added_count_ = 0;
  std::int32_t last_base_ = 0;
};

void write_head(const ChunkRecord& next, std::uint32_t back, std::string& out) {
  char head[kRecordHeadBytes];
  ByteWriter bytes(head);
  bytes.u8(kRecordDelta);
  bytes.u8(static_cast<unsigned>(next.key.layer));
  bytes.i32(next.key.x);
  bytes.i32(next.key.y);
  bytes.i32(next.key.z);
  bytes.u64(next.revision);
  out.append(head, kRecordHeadBytes);
  ByteAppender(out).varint(back);
}

}  // namespace

bool encode_delta(std::string_view base_bytes, std::string_view next_bytes, std::string& out) {
  const auto read = [](std::string_view bytes) {
    return decode_record(std::as_bytes(std::span(bytes.data(), bytes.size())));
  };
  const auto base = read(base_bytes), next = read(next_bytes);
  return base && next && encode_delta(*base, *next, next_bytes.size(), out);
}

bool encode_delta(const ChunkRecord& base, const ChunkRecord& next, std::size_t next_bytes,
                  std::string& out) {
  const std::uint64_t back = next.revision - base.revision;
  if (base.key != next.key || base.removed || next.removed || base.revision >= next.revision ||
      back > std::numeric_limits<std::uint32_t>::max() || !in_order(base.mesh.vertices) ||
      !in_order(next.mesh.vertices))
    return false;
  const std::size_t start = out.size();
  out.append(kRecordLengthBytes, '\0');
  write_head(next, static_cast<std::uint32_t>(back), out);
  Encoder(base.mesh, next.mesh, out).write();
  const std::size_t size = out.size() - start;
  if (size >= next_bytes) {
    out.resize(start);
    return false;
  }
  ByteWriter(out.data() + start).u32(static_cast<std::uint32_t>(size - kRecordLengthBytes));
  return true;
}

}  // namespace earthwork::protocol
