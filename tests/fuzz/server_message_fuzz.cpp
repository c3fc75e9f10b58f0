// What a server sends is read or refused by a client, whoever the server is.
#include "protocol/messages.hpp"
#include "tests/fuzz/expect.hpp"

namespace earthwork::protocol {
namespace {

void check(std::string_view text) {
  const auto message = parse_server_message(text);
  if (!message) {
    expect(!message.error().detail.empty(), "a refusal says why");
    return;
  }
  const auto again = parse_server_message(write(*message));
  expect(again && *again == *message, "read(write(m)) = m");
}

}  // namespace
}  // namespace earthwork::protocol

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  earthwork::protocol::check(earthwork::text_of(data, size));
  return 0;
}
