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

}  // namespace
}  // namespace earthwork::protocol
