#include "protocol/record_delta.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <optional>

#include "protocol/limits.hpp"
#include "tests/protocol/arbitrary.hpp"
#include "tests/protocol/readable.hpp"
#include "tests/protocol/samples.hpp"

namespace earthwork::protocol {
namespace {

/// Of two meshes of one chunk, revisions 258 and 300; nullopt when there is none.
std::optional<ChunkDelta> delta_of(const ChunkMesh& base, const ChunkMesh& next) {
  ChunkRecord after = record_of(next);
  after.revision = 300;
  std::string bytes;
  if (!encode_delta(encoded(record_of(base)), encoded(after), bytes)) {
    EXPECT_TRUE(bytes.empty());
    return std::nullopt;
  }
  EXPECT_LT(bytes.size(), encoded(after).size());
  EXPECT_TRUE(is_delta(bytes_of(bytes)));
  auto delta = decode_delta(bytes_of(bytes));
  EXPECT_TRUE(delta) << delta.error().detail;
  return std::move(*delta);
}

/// What the operations make of the mesh: "good", or why they are refused.
std::string outcome(const ChunkMesh& base, std::string operations) {
  const auto applied = apply_delta(
      base, {.key = {}, .revision = 2, .base_revision = 1, .operations = std::move(operations)});
  if (applied) return "good";
  EXPECT_EQ(applied.error().code, Code::bad_frame);
  return applied.error().detail;
}

/// A band like those of the samples with its vertices by y and then x; a bump moves one of its
/// upper vertices, and a gap leaves out the triangles of one column.
ChunkMesh row_mesh(int columns, int bump, int gap) {
  ChunkMesh mesh;
  const auto at = [](int i) { return static_cast<std::uint16_t>(i); };
  for (int i = 0; i <= columns; ++i) mesh.vertices.push_back({16384 + i * 1000, 16384});
  for (int i = 0; i <= columns; ++i)
    mesh.vertices.push_back({16384 + i * 1000 + (i == bump ? 77 : 0), 49152});
  for (int i = 0; i < columns; ++i) {
    if (i == gap) continue;
    const int up = i + columns + 1;
    mesh.triangles.insert(mesh.triangles.end(), {at(i), at(i + 1), at(up)});
    mesh.triangles.insert(mesh.triangles.end(), {at(i + 1), at(up + 1), at(up)});
  }
  for (int i = columns; i > 0; --i)
    mesh.sections.push_back({at(columns + 1 + i), at(columns + i), {0, 32767}, {0, 32767}});
  return mesh;
}

/// Any mesh with its vertices in order; what names them goes along.
ChunkMesh in_order(ChunkMesh mesh) {
  auto& vertices = mesh.vertices;
  const auto before = [](MeshPoint a, MeshPoint b) { return a.y != b.y ? a.y < b.y : a.x < b.x; };
  std::sort(vertices.begin(), vertices.end(), before);
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  const auto inside = [&](std::uint16_t i) { return i < vertices.size(); };
  std::vector<std::uint16_t> triangles;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3)
    if (std::all_of(&mesh.triangles[i], &mesh.triangles[i] + 3, inside))
      triangles.insert(triangles.end(), &mesh.triangles[i], &mesh.triangles[i] + 3);
  mesh.triangles = std::move(triangles);
  std::erase_if(mesh.sections, [&](const WallSection& s) { return !inside(s.a) || !inside(s.b); });
  return mesh;
}

TEST(RecordDelta, SaysOnlyWhatChanged) {
  const ChunkMesh base = row_mesh(200, -1, -1), next = row_mesh(200, 90, 120);
  const auto delta = delta_of(base, next);
  ASSERT_TRUE(delta);
  EXPECT_EQ(delta->key, (ChunkKey{2, -1, 3, 0}));
  EXPECT_EQ(delta->revision, 300u);
  EXPECT_EQ(delta->base_revision, 258u);
  EXPECT_LT(delta->operations.size(), 60u);
  const auto applied = apply_delta(base, *delta);
  ASSERT_TRUE(applied) << applied.error().detail;
  EXPECT_EQ(applied->mesh, next);
  EXPECT_EQ(applied->revision, 300u);
  EXPECT_EQ(applied->key, (ChunkKey{2, -1, 3, 0}));
}

TEST(RecordDelta, IsAppended) {
  ChunkRecord after = record_of(row_mesh(20, 3, 4));
  after.revision = 300;
  const std::string base = encoded(record_of(row_mesh(20, -1, -1)));
  std::string alone, bytes = "before";
  ASSERT_TRUE(encode_delta(base, encoded(after), alone));
  ASSERT_TRUE(encode_delta(base, encoded(after), bytes));
  EXPECT_EQ(bytes, "before" + alone);
}

RC_GTEST_PROP(RecordDelta, TurnsAnyMeshIntoAnyOther, ()) {
  const ChunkMesh base = in_order(*any_mesh(300));
  ChunkMesh next = in_order(*any_mesh(60));
  if (*rc::gen::arbitrary<bool>()) {  // mostly the same
    next = base;
    for (auto& normal : next.sections)
      if (*rc::gen::inRange(0, 8) == 0) normal.normal_b = {0, 32767};
    if (!next.vertices.empty()) next.vertices.back().x = *rc::gen::inRange(0, 2'129'920);
    next = in_order(next);
  }
  const auto delta = delta_of(base, next);
  RC_TAG(delta ? "delta" : "none");
  if (!delta) return;
  const auto applied = apply_delta(base, *delta);
  RC_ASSERT(applied.has_value());
  RC_ASSERT(applied->mesh == next);
}

// Of a base with 6 vertices, 4 triangles and 2 sections: 2 sections, none of them new, 2 copied
// from the first one; no vertex against the rule, none beside the walls; 4 triangles, 4 copied.
const std::vector<std::uint8_t> kSame = {2, 0, 2, 0, 0, 0, 4, 0x40};

std::string same_but(std::size_t at, std::vector<std::uint8_t> bytes) {
  std::string operations(kSame.begin(), kSame.end());
  return operations.replace(at, 1, std::string(bytes.begin(), bytes.end()));
}

TEST(RecordDelta, IsRefusedWhenCutAnywhere) {
  const ChunkMesh base = row_mesh(2, -1, -1);
  const std::string whole = same_but(0, {2});
  EXPECT_EQ(outcome(base, whole), "good");
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_EQ(outcome(base, whole.substr(0, size)), "delta: ends early, or has a bad varint");
  EXPECT_EQ(outcome(base, whole + '\0'), "delta: holds bytes after its end");
  EXPECT_EQ(outcome(square_mesh(), whole), "base: has vertices out of order");
}

TEST(RecordDelta, BoundsItsCounts) {
  const ChunkMesh base = row_mesh(2, -1, -1);
  EXPECT_EQ(outcome(base, same_but(0, {10})),
            "sections: are more than the base and the delta hold");
  EXPECT_EQ(outcome(base, same_but(1, {1})), "sections: are not as many as was said");
  EXPECT_EQ(outcome(base, same_but(2, {3, 0})), "sections: are copied from beyond the base");
  EXPECT_EQ(outcome(base, same_but(2, {0})), "sections: are not as many as was said");
  EXPECT_EQ(outcome(base, same_but(3, {1})), "sections: are copied from beyond the base");
  EXPECT_EQ(outcome(base, same_but(4, {1, 6})), "vertices: one is beyond those of the base");
  EXPECT_EQ(outcome(base, same_but(4, {1, 5})), "sections: one stands on a vertex that is gone");
  EXPECT_EQ(outcome(base, same_but(6, {6})),
            "triangles: are more than the base and the delta hold");
  EXPECT_EQ(outcome(base, same_but(7, {0x50})), "triangles: are not as many as was said");
  EXPECT_EQ(outcome(base, same_but(7, {0})), "triangles: are not as many as was said");
  EXPECT_EQ(outcome(base, same_but(7, {0x44})), "triangles: are copied from beyond the base");
}

/// The delta of the README, with the bytes from `at` on in place of `count` of its own.
std::string cut_but(std::size_t at, std::size_t count, std::vector<std::uint8_t> bytes) {
  const auto delta = delta_of(ordered_square_mesh(), cut_square_mesh());
  EXPECT_TRUE(delta);
  std::string operations = delta->operations;
  return operations.replace(at, count, std::string(bytes.begin(), bytes.end()));
}

// Offsets: the head, the y and the normal of the first new section, the count of vertices beside
// the walls, a triangle's varint.
constexpr std::size_t kSectionAt = 7, kYAt = 9, kNormalAt = 12, kBesideAt = 19, kTriangleAt = 22;

TEST(RecordDelta, BoundsNewSections) {
  const ChunkMesh base = ordered_square_mesh();
  const auto refused = [&](std::size_t at, std::size_t count, std::vector<std::uint8_t> bytes) {
    return outcome(base, cut_but(at, count, std::move(bytes)));
  };
  EXPECT_EQ(refused(0, 0, {}), "good");
  const std::string no_head = "sections: one starts nowhere, or has no head";
  EXPECT_EQ(refused(kSectionAt, 1, {0x8c, 0x02}), no_head);
  EXPECT_EQ(refused(kSectionAt, 1, {0x1c}), no_head) << "normal of a fourth kind";
  EXPECT_EQ(refused(kSectionAt, 1, {0x6c}), no_head);
  EXPECT_EQ(refused(kSectionAt, 1, {0x05}), no_head) << "no normal to go on with";
  EXPECT_EQ(outcome(base, std::string("\x01\x01\x00\x00", 4)), no_head);
  EXPECT_EQ(refused(kYAt, 3, {0x81, 0x80, 0x06}), "vertices: a coordinate is outside the chunk");
  EXPECT_EQ(refused(kYAt, 3, {0}), "sections: one ends where it starts");
  EXPECT_EQ(refused(kBesideAt, 1, {1, 0x80, 0x80, 0x03, 0x80, 0x80, 0x03}),
            "vertices: one is there twice");
  EXPECT_EQ(refused(kNormalAt, 1, {0xe0}), "sections: a normal's length is not 32767");
  EXPECT_EQ(refused(kNormalAt, 1, {0xf1}), "sections: a normal's length is not 32767");
  const auto one = [&](std::vector<std::uint8_t> bytes) {
    return outcome(base,
                   "\x01\x01" + std::string(1, '\0') + std::string(bytes.begin(), bytes.end()));
  };
  EXPECT_EQ(one({0x0f, 0}), "sections: one joins a copied one that is not there");
  EXPECT_EQ(one({0x0f, 32}), "sections: one names a vertex that is not there");
  EXPECT_EQ(one({0x0f, 1}), "sections: one names a vertex that is not there");
  EXPECT_EQ(one({0x0f, 3}), "sections: one names a vertex that is not there");
}

TEST(RecordDelta, BoundsNewTriangles) {
  const ChunkMesh base = ordered_square_mesh();
  const auto refused = [&](std::vector<std::uint8_t> bytes) {
    return outcome(base, cut_but(kTriangleAt, 1, std::move(bytes)));
  };
  const std::string nowhere =
      "triangles: a triangle names a vertex twice, or stands on no open edge";
  EXPECT_EQ(refused({0xa0, 0x06}), "triangles: an index is beyond the vertices");
  EXPECT_EQ(refused({0x08}), "triangles: an index is beyond the vertices") << "below 0";
  EXPECT_EQ(refused({0x83, 0x02}), "triangles: a triangle has no such form");
  EXPECT_EQ(refused({0x03}), nowhere);
  ChunkMesh open = base;
  open.sections.clear();
  EXPECT_EQ(outcome(open, std::string("\x00\x00\x00\x01\x01\x00", 6)), nowhere);
}

TEST(RecordDelta, BoundsItsHead) {
  ChunkRecord after = record_of(cut_square_mesh());
  after.revision = 300;
  std::string whole;
  ASSERT_TRUE(encode_delta(encoded(record_of(ordered_square_mesh())), encoded(after), whole));
  const auto refused = [&](std::size_t at, char byte) {
    std::string bytes = whole;
    bytes[at] = byte;
    const auto delta = decode_delta(bytes_of(bytes));
    return delta ? "good" : delta.error().detail;
  };
  EXPECT_EQ(refused(4, 3), "good");
  EXPECT_EQ(refused(0, 0), "length: is not that of the record, or beyond the limit");
  EXPECT_EQ(refused(4, 2), "kind: is not 3");
  EXPECT_EQ(refused(5, 16), "layer: is beyond the limit of 15");
  EXPECT_EQ(refused(9, 0), "key: is beyond the limit of 125072");
  EXPECT_EQ(refused(26, 0), "base revision: is not before the revision");
  EXPECT_FALSE(decode_delta(bytes_of(whole.substr(0, 26))));
}

TEST(RecordDelta, IsMadeOfFullRecordsOfOneChunkAlone) {
  const ChunkRecord base = record_of(row_mesh(20, -1, -1));
  ChunkRecord next = record_of(row_mesh(20, 3, -1));
  next.revision = 300;
  std::string out;
  const auto made = [&](const ChunkRecord& from, const ChunkRecord& to) {
    return encode_delta(encoded(from), encoded(to), out);
  };
  ASSERT_TRUE(made(base, next));
  out.clear();
  ChunkRecord other = next;
  other.key.x = 7;
  EXPECT_FALSE(made(base, other));
  EXPECT_FALSE(made(next, base)) << "backwards";
  other = next;
  other.revision = 258;
  EXPECT_FALSE(made(base, other));
  EXPECT_FALSE(made(removed_record(), next));
  other = record_of(square_mesh());
  other.revision = 300;
  EXPECT_FALSE(made(base, other)) << "vertices out of order";
  EXPECT_FALSE(encode_delta("", "x", out));
  EXPECT_FALSE(encode_delta(base, next, 40, out)) << "larger than the full record";
  EXPECT_TRUE(out.empty());
}

}  // namespace
}  // namespace earthwork::protocol
