// Deltas of anybody: the input is two records, a full one and, for the same chunk, a delta or
// another full one. What a delta makes keeps a mesh's promises; what is made of two records gives
// the second.
#include <algorithm>
#include <string>

#include "protocol/byte_reader.hpp"
#include "protocol/limits.hpp"
#include "protocol/record_delta.hpp"
#include "tests/fuzz/expect.hpp"
#include "tests/fuzz/mesh_promises.hpp"

namespace earthwork::protocol {
namespace {

using Bytes = std::span<const std::byte>;

Bytes bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

/// The record at the front of `input`, its length field made right; what follows is left in
/// `input`.
std::string take_record(Bytes& input) {
  const std::size_t said = ByteReader(input).u32();
  const std::size_t size = std::min({std::max<std::size_t>(said, 22) + 4, input.size()});
  std::string record(reinterpret_cast<const char*>(input.data()), size);
  for (std::size_t i = 0; i < 4 && i < size; ++i)
    record[i] = static_cast<char>((size - 4) >> (8 * i));
  input = input.subspan(size);
  return record;
}

void check_full_record(const ChunkMesh& mesh) {
  std::string bytes;
  encode_record({.key = {}, .revision = 1, .removed = false, .mesh = mesh}, bytes);
  const auto again = decode_record(bytes_of(bytes));
  expect(again && again->mesh == mesh, "a full record can hold what a delta makes");
}

/// The delta between two records, if there is one, makes the second of the first.
void check_between(const ChunkRecord& base, const ChunkRecord& next) {
  std::string bytes;
  if (!encode_delta(base, next, kMaxRecordBytes, bytes)) return;
  const auto delta = decode_delta(bytes_of(bytes));
  expect(delta.has_value(), "a delta that was made is read");
  expect(delta->key == base.key && delta->base_revision == base.revision, "the head is kept");
  const auto applied = apply_delta(base.mesh, *delta);
  expect(applied && *applied == next, "apply(delta(a, b), a) = b");
}

void check(Bytes input) {
  const auto base = decode_record(bytes_of(take_record(input)));
  if (!base || base->removed) return;
  const std::string second = take_record(input);
  if (!is_delta(bytes_of(second))) {
    auto next = decode_record(bytes_of(second));
    if (next) check_between(*base, *next);
    return;
  }
  const auto delta = decode_delta(bytes_of(second));
  if (!delta) return expect(!delta.error().detail.empty(), "a refusal says why");
  expect(delta->base_revision < delta->revision, "a delta goes forward");
  auto applied = apply_delta(base->mesh, *delta);
  if (!applied) return expect(!applied.error().detail.empty(), "a refusal says why");
  check_promises(applied->mesh);
  check_full_record(applied->mesh);
  applied->key = base->key;
  applied->revision = base->revision + 1;
  if (applied->revision != 0) check_between(*base, *applied);
}

}  // namespace
}  // namespace earthwork::protocol

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  earthwork::protocol::check(std::as_bytes(std::span(data, size)));
  return 0;
}
