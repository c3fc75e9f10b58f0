// encode_record: protocol/README.md, "Chunk record", is the specification.
#include <cassert>

#include "protocol/byte_writer.hpp"
#include "protocol/chunk_record.hpp"
#include "protocol/limits.hpp"
#include "protocol/record_format.hpp"

namespace earthwork::protocol {
namespace {

/// No mesh of these counts takes more.
std::size_t most_bytes(const ChunkMesh& mesh) {
  constexpr std::size_t kCoordinate = kMaxVarintBytes;
  constexpr std::size_t kIndex = 3, kChain = 6, kStep = 3;  // varints of 17, twice 16, 19 bits
  constexpr std::size_t kNormal = 4;
  return kRecordLengthBytes + kRecordHeadBytes + 3 * kMaxVarintBytes +
         mesh.vertices.size() * 2 * kCoordinate + mesh.triangles.size() * kIndex +
         mesh.sections.size() * (kChain + kStep + 2 * kNormal);
}

/// Columns rather than rows: the same bytes as they are, and neighbours in a column are alike,
/// which is what a compressor underneath lives on.
void write_vertices(const std::vector<MeshPoint>& vertices, ByteWriter& out) {
  std::int32_t before = 0;
  for (const MeshPoint& vertex : vertices) {
    out.varint(zigzag(vertex.x - before));
    before = vertex.x;
  }
  before = 0;
  for (const MeshPoint& vertex : vertices) {
    out.varint(zigzag(vertex.y - before));
    before = vertex.y;
  }
}

/// Steps from index to index: an outline's vertices are numbered along it, so most are one byte,
/// and half of what indices of a fixed width take in a chunk of more than 256 vertices.
void write_triangles(const std::vector<std::uint16_t>& triangles, ByteWriter& out) {
  std::int32_t before = 0;
  for (const std::uint16_t index : triangles) {
    out.varint(zigzag(index - before));
    before = index;
  }
}

void write_normal(MeshNormal normal, ByteWriter& out) {
  out.i16(normal.x);
  out.i16(normal.y);
}

/// The sections from `first` on that start where the one before them ended.
std::size_t chain_length(const std::vector<WallSection>& sections, std::size_t first) {
  std::size_t end = first + 1;
  while (end < sections.size() && sections[end].a == sections[end - 1].b) ++end;
  return end - first;
}

void write_chain(std::span<const WallSection> chain, ByteWriter& out) {
  out.varint(static_cast<std::uint32_t>(chain.size()));
  out.varint(chain.front().a);
  bool first = true;
  MeshNormal before;
  for (const WallSection& section : chain) {
    std::uint32_t flags = 0;
    if (first || section.normal_a != before) flags |= kStartNormalFollows;
    if (section.normal_b != section.normal_a) flags |= kEndNormalFollows;
    out.varint(zigzag(section.b - section.a) << kSectionFlagBits | flags);
    if (flags & kStartNormalFollows) write_normal(section.normal_a, out);
    if (flags & kEndNormalFollows) write_normal(section.normal_b, out);
    before = section.normal_b;
    first = false;
  }
}

void write_sections(const std::vector<WallSection>& sections, ByteWriter& out) {
  for (std::size_t first = 0; first < sections.size();) {
    const std::size_t length = chain_length(sections, first);
    write_chain({sections.data() + first, length}, out);
    first += length;
  }
}

void write_head(const ChunkRecord& record, ByteWriter& out) {
  out.u8(record.removed ? kRecordRemoved : kRecordFull);
  out.u8(static_cast<unsigned>(record.key.layer));
  out.i32(record.key.x);
  out.i32(record.key.y);
  out.i32(record.key.z);
  out.u64(record.revision);
}

}  // namespace

void encode_record(const ChunkRecord& record, std::string& out) {
  const ChunkMesh& mesh = record.mesh;
  assert(mesh.vertices.size() <= kMaxVertices && mesh.triangles.size() % 3 == 0);
  assert(0 <= record.key.layer && record.key.layer < static_cast<int>(kMaxLayers));
  const std::size_t start = out.size();
  out.resize(start + most_bytes(mesh));
  ByteWriter body(out.data() + start + kRecordLengthBytes);
  write_head(record, body);
  if (!record.removed) {
    body.varint(static_cast<std::uint32_t>(mesh.vertices.size()));
    body.varint(static_cast<std::uint32_t>(mesh.triangles.size() / 3));
    body.varint(static_cast<std::uint32_t>(mesh.sections.size()));
    write_vertices(mesh.vertices, body);
    write_triangles(mesh.triangles, body);
    write_sections(mesh.sections, body);
  }
  const auto end = static_cast<std::size_t>(body.at() - out.data());
  const std::size_t length = end - start - kRecordLengthBytes;
  assert(length <= kMaxRecordBytes);
  ByteWriter(out.data() + start).u32(static_cast<std::uint32_t>(length));
  out.resize(end);
}

}  // namespace earthwork::protocol
