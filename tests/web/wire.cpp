// What this build reads off the wire, told as text, so that a native build and the page's can be
// compared. Standard input is either a chunk record in hex, as the golden files hold them, or
// messages, a line each, which are read and written again.
#include <iostream>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/chunk_record.hpp"
#include "protocol/messages.hpp"

namespace earthwork::protocol {
namespace {

std::vector<std::byte> bytes_of_hex(const std::string& text) {
  std::vector<std::byte> bytes;
  for (std::size_t at = 0; at + 1 < text.size(); at += 3)
    bytes.push_back(static_cast<std::byte>(std::stoi(text.substr(at, 2), nullptr, 16)));
  return bytes;
}

std::string told(const std::vector<std::byte>& record) {
  const auto read = decode_record(record);
  if (!read) return "refused: " + read.error().detail;
  return "mesh hash " + hex(mesh_hash(read->mesh)) + ", key and hash " +
         hex(mesh_hash_term(read->key, mesh_hash(read->mesh)));
}

std::string told(const std::string& message) {
  if (const auto read = parse_client_message(message)) return write(*read);
  if (const auto read = parse_server_message(message)) return write(*read);
  return "refused";
}

}  // namespace
}  // namespace earthwork::protocol

int main() {
  using namespace earthwork::protocol;
  std::vector<std::byte> record;
  for (std::string line; std::getline(std::cin, line);) {
    if (line.starts_with('#') || line.empty()) continue;
    if (line.starts_with('{')) {
      std::cout << told(line) << '\n';
      continue;
    }
    const std::vector<std::byte> more = bytes_of_hex(line);
    record.insert(record.end(), more.begin(), more.end());
  }
  if (!record.empty()) std::cout << told(record) << '\n';
}
