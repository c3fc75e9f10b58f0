// A script is read whole, and line by line alike.
#include "protocol/script.hpp"
#include "tests/fuzz/expect.hpp"

namespace earthwork::protocol {
namespace {

void check(std::string_view text) {
  const auto script = read_script(text);
  if (!script) {
    expect(script.error().detail.rfind("line ", 0) == 0, "a refusal names its line");
    return;
  }
  if (text.find('\n') != std::string_view::npos || script->steps.size() != 1) return;
  const auto line = read_script_line(text);
  expect(line.has_value(), "the only line of a script can be read alone");
  if (const auto* edit = std::get_if<Edit>(&*line))
    expect(std::get<Edit>(script->steps[0]) == *edit, "and says the same");
  if (const auto* change = std::get_if<LayerChange>(&*line))
    expect(std::get<LayerChange>(script->steps[0]) == *change, "and so does a change of layers");
}

}  // namespace
}  // namespace earthwork::protocol

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  earthwork::protocol::check(earthwork::text_of(data, size));
  return 0;
}
