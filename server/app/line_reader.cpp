#include "server/app/line_reader.hpp"

namespace earthwork::app {

using protocol::Code;
using Line = std::optional<std::string_view>;

protocol::Result<Line> LineReader::next() {
  while (in_.peek() != std::istream::traits_type::eof()) {
    ++number_;
    in_.getline(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    if (in_.bad()) break;
    if (in_.fail())
      return protocol::fail(
          Code::too_large,
          "longer than the limit of " + std::to_string(protocol::kMaxControlBytes) + " bytes");
    // A line break that was taken off is counted; the last line may have none.
    const auto taken = static_cast<std::size_t>(in_.gcount()) - (in_.eof() ? 0 : 1);
    std::string_view line(buffer_.data(), taken);
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.find_first_not_of(" \t\r") != std::string_view::npos) return line;
  }
  if (in_.bad()) return protocol::fail(Code::storage_failed, "cannot be read");
  return Line{};
}

}  // namespace earthwork::app
