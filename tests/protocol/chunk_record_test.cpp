#include "protocol/chunk_record.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "protocol/limits.hpp"
#include "tests/protocol/arbitrary.hpp"
#include "tests/protocol/samples.hpp"

namespace earthwork::protocol {
namespace {

// Offsets in a record's bytes.
constexpr std::size_t kKind = 4, kLayer = 5, kX = 6, kCounts = 26;

std::string refusal(std::string_view bytes) {
  const auto record = decode_record(bytes_of(bytes));
  if (record) return "good";
  EXPECT_EQ(record.error().code, Code::bad_frame);
  return record.error().detail;
}

/// `bytes` with its length field made right again.
std::string with_length(std::string bytes) {
  for (std::size_t i = 0; i < 4; ++i) bytes[i] = static_cast<char>((bytes.size() - 4) >> (8 * i));
  return bytes;
}

/// A full record that holds `mesh` after the head, whatever it says.
std::string with_body(std::string_view mesh) {
  return with_length(encoded(record_of({})).substr(0, kCounts) + std::string(mesh));
}

TEST(ChunkRecord, KeepsEverythingExactly) {
  for (const ChunkMesh& mesh :
       {ChunkMesh{}, square_mesh(), bend_mesh(), band_mesh(127), band_mesh(128), band_mesh(2000)}) {
    const ChunkRecord record = record_of(mesh);
    const auto decoded = decode_record(bytes_of(encoded(record)));
    ASSERT_TRUE(decoded) << decoded.error().detail;
    EXPECT_EQ(*decoded, record);
    EXPECT_EQ(mesh_hash(decoded->mesh), mesh_hash(mesh));
  }
  EXPECT_EQ(*decode_record(bytes_of(encoded(removed_record()))), removed_record());
}

TEST(ChunkRecord, IsSmall) {
  EXPECT_EQ(encoded(removed_record()).size(), 26u);
  EXPECT_EQ(encoded(record_of(square_mesh())).size(), 75u);
  // Every index and every flat section of a chain is one byte here.
  EXPECT_EQ(encoded(record_of(band_mesh(128))).size(), 2097u);
}

TEST(ChunkRecord, IsAppended) {
  std::string bytes = "before";
  encode_record(removed_record(), bytes);
  EXPECT_EQ(bytes, "before" + encoded(removed_record()));
}

RC_GTEST_PROP(ChunkRecord, SurvivesTheRoundTrip, ()) {
  const ChunkRecord record = *any_record(700);
  const auto decoded = decode_record(bytes_of(encoded(record)));
  RC_ASSERT(decoded.has_value());
  RC_ASSERT(*decoded == record);
}

RC_GTEST_PROP(ChunkRecord, DecodesToNothingWorseWhenBytesChange, ()) {
  std::string bytes = encoded(*any_record(40));
  for (auto left = *rc::gen::inRange(1, 4); left > 0; --left)
    bytes[*rc::gen::inRange<std::size_t>(4, bytes.size())] = *rc::gen::arbitrary<char>();
  const auto decoded = decode_record(bytes_of(bytes));
  if (!decoded) return;
  RC_ASSERT(*decode_record(bytes_of(encoded(*decoded))) == *decoded);
}

TEST(ChunkRecord, IsRefusedWhenCutAnywhere) {
  const std::string whole = encoded(record_of(bend_mesh()));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_NE(refusal(whole.substr(0, size)), "good") << size;
    if (size >= 4) EXPECT_NE(refusal(with_length(whole.substr(0, size))), "good") << size;
  }
  EXPECT_EQ(refusal(whole + '\0'), "length: is not that of the record, or beyond the limit");
  EXPECT_EQ(refusal(with_length(whole + '\0')), "record: holds bytes after its end");
  EXPECT_EQ(refusal(with_length(encoded(removed_record()) + '\0')),
            "record: holds bytes after its end");
}

TEST(ChunkRecord, BoundsItsHead) {
  std::string bytes = encoded(removed_record());
  bytes[kKind] = 3;
  EXPECT_EQ(refusal(bytes), "kind: is not 1 or 2");
  bytes = encoded(removed_record());
  bytes[kLayer] = 15;
  EXPECT_EQ(refusal(bytes), "good");
  bytes[kLayer] = 16;
  EXPECT_EQ(refusal(bytes), "layer: is beyond the limit of 15");
  ChunkRecord far = removed_record();
  far.key.x = -125'072;
  EXPECT_EQ(refusal(encoded(far)), "good");
  far.key.x = -125'073;
  EXPECT_EQ(refusal(encoded(far)), "key: is beyond the limit of 125072");
  far.key = {0, 0, 0, 125'073};
  EXPECT_EQ(refusal(encoded(far)), "key: is beyond the limit of 125072");
  bytes = encoded(removed_record());
  bytes[kX + 3] = '\x80';
  EXPECT_EQ(refusal(bytes), "key: is beyond the limit of 125072");
}

TEST(ChunkRecord, BoundsItsCountsBeforeItTakesMemory) {
  using std::string;
  const string many("\xff\xff\x03", 3), more("\x80\x80\x04", 3), most("\xff\xff\xff\xff\x0f", 5);
  const string none(1, '\0');
  EXPECT_EQ(refusal(with_body(none + none + none)), "good");
  EXPECT_EQ(refusal(with_body(many + none + none)), "counts: ask for more than the record holds");
  EXPECT_EQ(refusal(with_body(more + none + none)), "vertices: are beyond the limit of 65535");
  EXPECT_EQ(refusal(with_body(none + most + none)), "counts: ask for more than the record holds");
  EXPECT_EQ(refusal(with_body(none + none + most)), "counts: ask for more than the record holds");
  EXPECT_EQ(refusal(with_body(string("\x80\x00", 2) + none + none)),
            "counts: ask for more than the record holds");
}

TEST(ChunkRecord, TakesSixtyFiveThousandVerticesAndNotOneMore) {
  ChunkMesh mesh;
  mesh.vertices.resize(65535);
  mesh.triangles = {65534, 0, 65533};
  mesh.sections = {{65534, 0, {32767, 0}, {0, 32767}}, {0, 65534, {0, 32767}, {0, 32767}}};
  const ChunkRecord record = record_of(mesh);
  const auto decoded = decode_record(bytes_of(encoded(record)));
  ASSERT_TRUE(decoded);
  EXPECT_EQ(*decoded, record);
}

TEST(ChunkRecord, BoundsCoordinates) {
  ChunkMesh mesh;
  mesh.vertices = {{2'129'919, 0}, {0, 2'129'919}};
  EXPECT_EQ(refusal(encoded(record_of(mesh))), "good");
  mesh.vertices = {{0, 2'129'920}};
  EXPECT_EQ(refusal(encoded(record_of(mesh))), "vertices: a coordinate is outside the chunk");
  mesh.vertices = {{5, 0}, {-1, 0}};
  EXPECT_EQ(refusal(encoded(record_of(mesh))), "vertices: a coordinate is outside the chunk");
}

TEST(ChunkRecord, BoundsIndices) {
  ChunkMesh mesh = square_mesh();
  mesh.triangles[5] = 4;
  EXPECT_EQ(refusal(encoded(record_of(mesh))), "triangles: an index is beyond the vertices");
  for (const auto& twice : {std::vector<std::uint16_t>{1, 1, 2}, {1, 2, 2}, {1, 2, 1}}) {
    mesh.triangles = twice;
    EXPECT_EQ(refusal(encoded(record_of(mesh))), "triangles: a triangle names a vertex twice");
  }
}

TEST(ChunkRecord, BoundsSections) {
  ChunkMesh mesh = square_mesh();
  mesh.sections[2].b = 4;
  EXPECT_EQ(refusal(encoded(record_of(mesh))),
            "sections: a section ends beyond the vertices, or where it starts");
  mesh.sections[2].b = mesh.sections[2].a;
  EXPECT_EQ(refusal(encoded(record_of(mesh))),
            "sections: a section ends beyond the vertices, or where it starts");
  mesh = square_mesh();
  mesh.sections[0].a = 7;
  EXPECT_EQ(refusal(encoded(record_of(mesh))), "sections: a chain starts beyond the vertices");
}

TEST(ChunkRecord, BoundsTheLengthOfNormals) {
  ChunkMesh mesh = square_mesh();
  for (const MeshNormal good : {MeshNormal{23170, -23170}, {-32767, 0}, {23169, 23170}}) {
    mesh.sections[0].normal_b = good;
    EXPECT_EQ(refusal(encoded(record_of(mesh))), "good");
  }
  for (const MeshNormal bad :
       {MeshNormal{0, 0}, {32760, 0}, {32767, 300}, {INT16_MIN, INT16_MIN}}) {
    mesh.sections[0].normal_b = bad;
    EXPECT_EQ(refusal(encoded(record_of(mesh))), "sections: a normal's length is not 32767");
  }
}

TEST(ChunkRecord, BoundsChains) {
  using std::string;
  const string two_vertices("\x02\x00\x01\x02\x02\x00\x00", 7);  // counts, then (1, 0), (2, 0)
  const string down("\x00\x00\x01\x80", 4);
  EXPECT_EQ(refusal(with_body(two_vertices + string("\x01\x00\x09", 3) + down)), "good");
  EXPECT_EQ(refusal(with_body(two_vertices + string("\x00\x00\x01\x00\x09", 5) + down)),
            "sections: a chain's length is 0 or beyond the count of sections");
  EXPECT_EQ(refusal(with_body(two_vertices + string("\x02\x00\x09", 3) + down)),
            "sections: a chain's length is 0 or beyond the count of sections");
  EXPECT_EQ(refusal(with_body(two_vertices + string("\x01\x00\x08", 3) + down)),
            "sections: a chain has no normal at its start");
}

}  // namespace
}  // namespace earthwork::protocol
