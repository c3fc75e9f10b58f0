// Triangles of both meshes come in the order of their highest corners, but for a few at the end. So
// what is the same is found by going along both; what is missed is only sent again.
#include "protocol/record_delta_triangles.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "protocol/limits.hpp"
#include "protocol/open_edges.hpp"
#include "protocol/record_delta_format.hpp"
#include "protocol/record_format.hpp"

namespace earthwork::protocol {
namespace {

using Triangle = OpenEdges::Corners;

/// Triangles of one highest corner that are looked through for the next one.
constexpr std::size_t kLookAhead = 64;

std::uint32_t highest(const Triangle& corners) {
  return std::max({corners[0], corners[1], corners[2]});
}

class TriangleWriter {
 public:
  TriangleWriter(const ChunkMesh& base, const ChunkMesh& next,
                 std::span<const std::uint32_t> of_base, ByteAppender& out)
      : base_(base), next_(next), of_base_(of_base), out_(out), edges_(next) {}

  void write() {
    const std::vector<Triangle> base = kept();
    next_triangles_.reserve(next_.triangles.size() / 3);
    for (std::size_t i = 0; i < next_.triangles.size(); i += 3)
      next_triangles_.push_back(
          {next_.triangles[i], next_.triangles[i + 1], next_.triangles[i + 2]});
    out_.varint(static_cast<std::uint32_t>(next_triangles_.size()));
    std::size_t at = 0;  // in the base
    for (std::size_t j = 0; j < next_triangles_.size(); ++j) {
      const auto [found, same] = find(base, at, next_triangles_[j]);
      skip(found - at);
      at = found;
      if (same) {
        copy(j);
        ++at;
      } else {
        add(j);
      }
    }
    finish();
  }

 private:
  struct Run {
    std::size_t copied = 0, skipped = 0, first = 0, added = 0;  // `first` of those added
  };
  struct Found {
    std::size_t at = 0;
    bool same = false;
  };

  /// The triangles of the base whose corners are all kept, by their numbers in the next mesh.
  std::vector<Triangle> kept() const {
    std::vector<Triangle> kept;
    kept.reserve(base_.triangles.size() / 3);
    for (std::size_t i = 0; i < base_.triangles.size(); i += 3) {
      const Triangle triangle{of_base_[base_.triangles[i]], of_base_[base_.triangles[i + 1]],
                              of_base_[base_.triangles[i + 2]]};
      if (highest(triangle) != kNoVertex) kept.push_back(triangle);
    }
    return kept;
  }

  /// Where `triangle` is in the base from `at` on, or where those before it end.
  static Found find(const std::vector<Triangle>& base, std::size_t at, const Triangle& triangle) {
    const std::uint32_t v = highest(triangle);
    while (at < base.size() && highest(base[at]) < v) ++at;
    const std::size_t end = std::min(base.size(), at + kLookAhead);
    for (std::size_t i = at; i < end && highest(base[i]) == v; ++i)
      if (base[i] == triangle) return {i, true};
    return {at, false};
  }

  void copy(std::size_t j) {
    if (run_.skipped > 0 || run_.added > 0) finish();
    ++run_.copied;
    run_.first = j + 1;
    edges_.put(next_triangles_[j]);
  }
  void skip(std::size_t count) {
    if (count > 0 && run_.added > 0) finish();
    run_.skipped += count;
  }
  void add(std::size_t j) {
    if (run_.added++ == 0) run_.first = j;
  }

  void finish() {
    const auto few = [](std::size_t many) {
      return std::min(static_cast<std::uint32_t>(many), kManyTriangles);
    };
    const std::uint32_t head =
        static_cast<std::uint32_t>(run_.copied) << 4 | few(run_.skipped) << 2 | few(run_.added);
    if (head == 0) return;
    out_.varint(head);
    for (const std::size_t many : {run_.skipped, run_.added})
      if (many >= kManyTriangles) out_.varint(static_cast<std::uint32_t>(many) - kManyTriangles);
    if (run_.copied > 0) last_ = next_triangles_[run_.first - 1];
    for (std::size_t j = run_.first; j < run_.first + run_.added; ++j) {
      write_triangle(next_triangles_[j]);
      last_ = next_triangles_[j];
    }
    run_ = {};
  }

  void write_triangle(const Triangle& triangle) {
    for (const auto form :
         {TriangleForm::into_it, TriangleForm::out_of_it, TriangleForm::closing}) {
      const std::uint32_t v = triangle[form == TriangleForm::out_of_it ? 0 : 2];
      if (triangle_at(edges_, form, v) != triangle) continue;
      const auto step = static_cast<std::int32_t>(v) - static_cast<std::int32_t>(highest(last_));
      out_.varint(zigzag(step) << kFormBits | static_cast<std::uint32_t>(form));
      return edges_.put(triangle);
    }
    write_corners(triangle);
    edges_.put(triangle);
  }

  void write_corners(const Triangle& triangle) {
    std::array<std::uint32_t, 3> codes{};
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      while (codes[k] < 3 && last_[codes[k]] != triangle[k]) ++codes[k];
      bits |= codes[k] << (2 * k);
    }
    out_.varint(bits << kFormBits | static_cast<std::uint32_t>(TriangleForm::corners));
    std::uint32_t before = last_[0];
    for (std::size_t k = 0; k < 3; ++k) {
      if (codes[k] == kCornerFollows) out_.step(static_cast<std::int64_t>(triangle[k]) - before);
      before = triangle[k];
    }
  }

  const ChunkMesh& base_;
  const ChunkMesh& next_;
  std::span<const std::uint32_t> of_base_;
  ByteAppender& out_;
  OpenEdges edges_;
  std::vector<Triangle> next_triangles_;
  Run run_;
  Triangle last_{};  // the one before, copied or added
};

class TriangleReader {
 public:
  TriangleReader(ByteReader& in, const ChunkMesh& base, std::span<const std::uint32_t> of_base,
                 ChunkMesh& mesh)
      : in_(in), base_(base), of_base_(of_base), mesh_(mesh), edges_(mesh) {}

  Result<void> read() {
    read_runs();
    if (failure_) return tl::unexpected<Failure>(std::move(*failure_));
    return {};
  }

 private:
  void read_runs() {
    const std::size_t count = in_.varint();
    if (count > base_.triangles.size() / 3 + in_.remaining())
      return refuse("triangles", "are more than the base and the delta hold");
    if (2 * mesh_.vertices.size() + 3 * count + mesh_.sections.size() > kMaxRecordBytes)
      return refuse("triangles", "make the mesh larger than a record");
    mesh_.triangles.reserve(count * 3);
    const auto left = [&] { return count - mesh_.triangles.size() / 3; };
    while (good() && left() > 0) {
      const std::uint32_t head = in_.varint();
      const std::size_t copied = head >> 4;
      const std::size_t skipped = read_many(head >> 2 & 3), added = read_many(head & 3);
      if (copied > left() || added > left() - copied || head == 0)
        return refuse("triangles", "are not as many as was said");
      pass_triangles(copied, true);
      pass_triangles(skipped, false);
      for (std::size_t i = 0; i < added && good(); ++i) read_triangle();
    }
  }

  std::size_t read_many(std::uint32_t few) {
    return few < kManyTriangles ? few : std::size_t{kManyTriangles} + in_.varint();
  }

  void pass_triangles(std::size_t count, bool copy) {
    const auto& all = base_.triangles;
    for (; count > 0; base_at_ += 3) {
      if (base_at_ >= all.size()) return refuse("triangles", "are copied from beyond the base");
      const std::uint32_t a = of_base_[all[base_at_]], b = of_base_[all[base_at_ + 1]],
                          c = of_base_[all[base_at_ + 2]];
      if (a == kNoVertex || b == kNoVertex || c == kNoVertex) continue;
      --count;
      if (copy) put_triangle({a, b, c});
    }
  }

  void read_triangle() {
    const std::uint32_t bits = in_.varint(), value = bits >> kFormBits;
    const auto form = static_cast<TriangleForm>(bits & 3);
    if (form == TriangleForm::corners) return read_corners(value);
    const std::int64_t v = std::max({last_[0], last_[1], last_[2]}) + std::int64_t{unzigzag(value)};
    if (v < 0 || v >= static_cast<std::int64_t>(mesh_.vertices.size()))
      return refuse("triangles", "an index is beyond the vertices");
    put_triangle(triangle_at(edges_, form, static_cast<std::uint32_t>(v)));
  }

  void read_corners(std::uint32_t codes) {
    if (codes >> kCornersBits != 0) return refuse("triangles", "a triangle has no such form");
    OpenEdges::Corners corners{};
    std::int64_t value = last_[0];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t code = codes >> (2 * i) & 3;
      value = code == kCornerFollows ? value + unzigzag(in_.varint()) : last_[code];
      if (value < 0 || value >= static_cast<std::int64_t>(mesh_.vertices.size()))
        return refuse("triangles", "an index is beyond the vertices");
      corners[i] = static_cast<std::uint32_t>(value);
    }
    put_triangle(corners);
  }

  void put_triangle(const OpenEdges::Corners& corners) {
    const auto [a, b, c] = corners;
    if (a == b || b == c || c == a || std::max({a, b, c}) == OpenEdges::kNone)
      return refuse("triangles", "a triangle names a vertex twice, or stands on no open edge");
    for (const std::uint32_t corner : corners)
      mesh_.triangles.push_back(static_cast<std::uint16_t>(corner));
    edges_.put(corners);
    last_ = corners;
  }

  bool good() const { return !failure_ && !in_.failed(); }
  void refuse(const char* field, const std::string& sentence) {
    if (good()) failure_ = frame_failure(field, sentence);
  }

  ByteReader& in_;
  const ChunkMesh& base_;
  std::span<const std::uint32_t> of_base_;
  ChunkMesh& mesh_;
  OpenEdges edges_;
  std::size_t base_at_ = 0;  // index of the next triangle of the base
  Triangle last_{};
  std::optional<Failure> failure_;
};

}  // namespace

void write_triangles(const ChunkMesh& base, const ChunkMesh& next,
                     std::span<const std::uint32_t> of_base, ByteAppender& out) {
  TriangleWriter(base, next, of_base, out).write();
}

Result<void> read_triangles(ByteReader& in, const ChunkMesh& base,
                            std::span<const std::uint32_t> of_base, ChunkMesh& mesh) {
  return TriangleReader(in, base, of_base, mesh).read();
}

}  // namespace earthwork::protocol
