#include "protocol/script.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "protocol/json_fields.hpp"
#include "protocol/json_text.hpp"
#include "protocol/limits.hpp"

namespace earthwork::protocol {
namespace {

bool is_blank(std::string_view line) {
  return line.find_first_not_of(" \t\r\n") == std::string_view::npos;
}

/// Takes the first line off `text`, without its line break.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

bool has_a_field_of_an_edit(const JsonFields& line) {
  constexpr std::array kFields{"stencil", "fill", "x", "y", "path", "radius", "layer", "stroke"};
  return std::any_of(kFields.begin(), kFields.end(),
                     [&](const char* field) { return line.has(field); });
}

ScriptLine as_line(Action&& action) {
  return std::visit([](auto&& asked) { return ScriptLine(std::move(asked)); }, std::move(action));
}

/// Adds what `line` holds to `script`.
Result<void> take_step(std::string_view line, Script& script) {
  auto read = read_script_line(line);
  if (!read) return tl::unexpected<Failure>(std::move(read.error()));
  if (auto* edit = std::get_if<Edit>(&*read)) {
    script.steps.emplace_back(std::move(*edit));
  } else if (auto* change = std::get_if<LayerChange>(&*read)) {
    script.steps.emplace_back(std::move(*change));
  } else if (const auto* wait = std::get_if<Wait>(&*read)) {
    script.steps.emplace_back(*wait);
  } else if (!std::holds_alternative<Note>(*read)) {
    if (script.settings || !script.steps.empty())
      return fail(Code::bad_message, "map: settings stand on the first line only", "map");
    script.settings = std::get<MapSettings>(std::move(*read));
  }
  return {};
}

}  // namespace

Result<ScriptLine> read_script_line(std::string_view line) {
  auto json = parse_json(line, kMaxControlBytes);
  if (!json) return tl::unexpected<Failure>(std::move(json.error()));
  JsonFields in(*json, {}, Code::bad_message);
  if (in.has("map"))
    return read_settings((*json)["map"]).map([](auto&& s) { return ScriptLine(s); });
  if (in.has("stencil") || in.has("kind")) return read_action(*json).map(as_line);
  if (in.has("wait_ms")) return in.result<ScriptLine>(Wait{in.integer("wait_ms", {0, kMaxWaitMs})});
  if (in.has("generate"))
    in.refuse(Code::not_supported, "generate", "generators are not offered");
  else if (has_a_field_of_an_edit(in))
    in.refuse(Failure{Code::bad_message, "not a line with map, stencil, wait_ms or kind", {}});
  return in.result<ScriptLine>(Note{});
}

Result<Script> read_script(std::string_view text) {
  Script script;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::string_view line = take_line(text);
    if (is_blank(line)) continue;
    auto taken = take_step(line, script);
    if (taken) continue;
    Failure failure = std::move(taken.error());
    failure.detail.insert(0, "line " + std::to_string(number) + ": ");
    return tl::unexpected<Failure>(std::move(failure));
  }
  return script;
}

}  // namespace earthwork::protocol
