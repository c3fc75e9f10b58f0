// A line of a recording is read or refused, and what is read is a line of a script.
#include "protocol/recording.hpp"

#include "protocol/script.hpp"
#include "tests/fuzz/expect.hpp"

namespace earthwork::protocol {
namespace {

void check_event(std::string_view text) {
  const auto event = read_recorded_event(text);
  if (!event) {
    expect(!event.error().detail.empty(), "a refusal says why");
    return;
  }
  const auto again = read_recorded_event(write(*event));
  expect(again && *again == *event, "read(write(e)) = e");
  const auto line = read_script_line(write(*event));
  expect(line.has_value(), "an event is a step of a script");
  const auto same = [&line](const auto& action) { return ScriptLine(action) == *line; };
  expect(std::visit(same, event->action), "and says the same");
}

void check_head(std::string_view text) {
  const auto head = read_recording_head(text);
  if (!head) return expect(!head.error().detail.empty(), "a refusal says why");
  const auto again = read_recording_head(write(*head));
  expect(again && *again == *head, "read(write(h)) = h");
}

}  // namespace
}  // namespace earthwork::protocol

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  earthwork::protocol::check_event(earthwork::text_of(data, size));
  earthwork::protocol::check_head(earthwork::text_of(data, size));
  return 0;
}
