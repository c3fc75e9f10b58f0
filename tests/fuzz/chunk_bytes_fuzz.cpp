// A kept chunk's bytes of anybody: refused, or the only form of what they say.
#include <span>
#include <string>

#include "server/voxel/chunk_bytes.hpp"
#include "tests/fuzz/expect.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace earthwork;
  const auto chunk = voxel::decode_chunk(std::as_bytes(std::span(data, size)));
  if (!chunk) return 0;
  expect(size <= voxel::kMaxChunkBytes, "a chunk has few bytes");
  std::string bytes;
  voxel::encode_chunk(*chunk, bytes);
  expect(bytes == text_of(data, size), "encode(decode(bytes)) = bytes");
  return 0;
}
