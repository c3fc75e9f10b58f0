// Binary messages of anybody: the input is a row of messages, each after its u16 length. What is
// decoded keeps a mesh's promises and is the same after another round.
#include "protocol/frame.hpp"

#include <algorithm>

#include "tests/fuzz/expect.hpp"
#include "tests/fuzz/mesh_promises.hpp"

namespace earthwork::protocol {
namespace {

void check(const ChunkRecord& record) {
  check_promises(record.mesh);
  std::string bytes;
  encode_record(record, bytes);
  const auto again = decode_record(std::as_bytes(std::span(bytes.data(), bytes.size())));
  expect(again && *again == record, "decode(encode(r)) = r");
  expect(mesh_hash(again->mesh) == mesh_hash(record.mesh), "the same hash");
}

void check(std::span<const std::byte> input) {
  FrameReader reader;
  std::vector<FrameEvent> events;
  while (input.size() >= 2) {
    const auto at = [&](std::size_t i) { return std::to_integer<std::size_t>(input[i]); };
    const std::size_t size = std::min(at(0) | at(1) << 8, input.size() - 2);
    const auto fed = reader.feed(input.subspan(2, size), events);
    if (!fed) {
      expect(!fed.error().detail.empty(), "a refusal says why");
      break;
    }
    input = input.subspan(2 + size);
  }
  for (const FrameEvent& event : events)
    if (const auto* record = std::get_if<ChunkRecord>(&event))
      check(*record);
    else if (const auto* delta = std::get_if<ChunkDelta>(&event))
      expect(delta->base_revision < delta->revision, "a delta goes forward");
}

}  // namespace
}  // namespace earthwork::protocol

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span(data, size));
  earthwork::protocol::check(bytes);
  if (const auto record = earthwork::protocol::decode_record(bytes))
    earthwork::protocol::check(*record);
  return 0;
}
