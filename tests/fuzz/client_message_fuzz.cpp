// What a client sends is read or refused; what is read can be written and read again, and the
// limits that need a map can be checked of it.
#include "protocol/messages.hpp"
#include "tests/fuzz/expect.hpp"

namespace earthwork::protocol {
namespace {

void check_limits(const ClientMessage& message, const MapSettings& settings) {
  if (const auto* edit = std::get_if<EditMessage>(&message))
    if (const auto checked = check_edit(edit->edit, settings); !checked)
      expect(!checked.error().field.empty(), "a refused edit names its field");
  if (const auto* layer = std::get_if<LayerMessage>(&message)) {
    MapSettings changed = settings;
    const auto checked = check_layer_change(layer->change, changed);
    if (checked) apply(layer->change, changed);
    expect(changed.layers.size() <= kMaxLayers, "no map gets more layers than it may have");
    expect(checked || !checked.error().field.empty(), "a refused change names its field");
  }
  if (const auto* view = std::get_if<View>(&message))
    if (const auto checked = check_view(*view, settings); !checked)
      expect(checked.error().code == Code::too_large, "a view is refused for its size alone");
}

void check(std::string_view text) {
  const auto message = parse_client_message(text);
  const auto id = salvage_id(text);
  if (!message) {
    expect(!message.error().detail.empty(), "a refusal says why");
    return;
  }
  const auto own = std::visit([](const auto& m) { return std::optional(m.id); }, *message);
  expect(own == id, "the id is found without reading the rest");
  const auto again = parse_client_message(write(*message));
  expect(again && *again == *message, "read(write(m)) = m");
  MapSettings small{.chunk_resolution = 8, .chunks = {{-2, -2, 3, 3}}, .voxel_size = 1e-6};
  small.layers.resize(16);
  check_limits(*message, MapSettings{});
  check_limits(*message, small);
}

}  // namespace
}  // namespace earthwork::protocol

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  earthwork::protocol::check(earthwork::text_of(data, size));
  return 0;
}
