#include "protocol/action.hpp"

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "protocol/json_fields.hpp"

namespace earthwork::protocol {
namespace {

constexpr std::string_view kEdit = "edit", kLayer = "layer";

}  // namespace

std::string_view kind(const Action& action) {
  return std::holds_alternative<Edit>(action) ? kEdit : kLayer;
}

Result<Action> read_action(const nlohmann::json& json, std::string_view kind) {
  if (kind == kLayer)
    return read_layer_change(json).map(
        [](LayerChange&& change) { return Action(std::move(change)); });
  if (kind == kEdit)
    return read_edit(json).map([](Edit&& edit) { return Action(std::move(edit)); });
  return fail(Code::not_supported, "kind: is not known here", "kind");
}

Result<Action> read_action(const nlohmann::json& json) {
  JsonFields in(json);
  const std::string kind = in.has("kind") ? in.text("kind") : std::string(kEdit);
  if (in.failed()) return in.result(Action{});
  return read_action(json, kind);
}

void write_fields(const Action& action, nlohmann::ordered_json& out) {
  if (const auto* edit = std::get_if<Edit>(&action))
    write_edit(*edit, out);
  else
    write_layer_change(std::get<LayerChange>(action), out);
}

void write_action(const Action& action, nlohmann::ordered_json& out) {
  out["kind"] = kind(action);
  write_fields(action, out);
}

Result<void> check_layers(const Action& action, const MapSettings& settings) {
  if (const auto* edit = std::get_if<Edit>(&action)) return check_layer(*edit, settings);
  return check_layer_change(std::get<LayerChange>(action), settings);
}

Result<void> check_action(const Action& action, const MapSettings& settings) {
  if (const auto* edit = std::get_if<Edit>(&action)) return check_edit(*edit, settings);
  return check_layers(action, settings);
}

std::size_t points(const Action& action) {
  const auto* edit = std::get_if<Edit>(&action);
  return edit ? edit->path.size() : 1;
}

void apply(const Action& action, MapSettings& settings) {
  if (const auto* change = std::get_if<LayerChange>(&action)) apply(*change, settings);
}

}  // namespace earthwork::protocol
