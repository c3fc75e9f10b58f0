// An author's kept ids of anybody: refused, or the only form of what they say.
#include <span>

#include "server/journal/author_ids.hpp"
#include "tests/fuzz/expect.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace earthwork;
  const auto ids = journal::decode_ids(std::as_bytes(std::span(data, size)));
  if (ids)
    expect(journal::encode_ids(*ids) == text_of(data, size), "encode(decode(bytes)) = bytes");
  return 0;
}
