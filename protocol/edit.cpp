#include "protocol/edit.hpp"

#include <nlohmann/json.hpp>
#include <string>

#include "protocol/json_fields.hpp"
#include "protocol/limits.hpp"

namespace earthwork::protocol {
namespace {

using nlohmann::json;

std::vector<MapPoint> read_path(JsonFields& in) {
  std::vector<MapPoint> path;
  const json* array = in.array("path", 1, kMaxPathPoints);
  if (!array) return path;
  path.reserve(array->size());
  for (const json& point : *array) {
    if (!point.is_array() || point.size() != 2 || !point[0].is_number() || !point[1].is_number()) {
      in.refuse(Code::bad_field, "path",
                "element " + std::to_string(path.size()) + " is not a point [x, y]");
      return path;
    }
    path.push_back({point[0].get<double>(), point[1].get<double>()});
  }
  return path;
}

}  // namespace

std::string_view name(StencilShape shape) {
  return shape == StencilShape::square ? "square" : "circle";
}

StencilShape read_stencil(JsonFields& in) {
  const std::string shape = in.text("stencil");
  if (shape == "square") return StencilShape::square;
  if (shape != "circle") in.refuse(Code::bad_field, "stencil", "is not \"square\" or \"circle\"");
  return StencilShape::circle;
}

Result<Edit> read_edit(const json& json) {
  JsonFields in(json);
  Edit edit;
  if (in.has("layer"))
    edit.layer = static_cast<std::uint32_t>(in.integer("layer", {0, kMaxLayers - 1}));
  edit.stencil = read_stencil(in);
  edit.fill = in.boolean("fill");
  edit.is_path = in.has("path");
  if (!edit.is_path)
    edit.path = {{in.number("x"), in.number("y")}};
  else if (in.has("x") || in.has("y"))
    in.refuse(Code::bad_field, "path", "stands in place of x and y, not beside them");
  else
    edit.path = read_path(in);
  edit.radius = in.number("radius");
  if (edit.radius < 0) in.refuse(Code::out_of_range, "radius", "is below 0");
  if (in.has("stroke")) edit.stroke = in.integer("stroke", {-kMaxInteger, kMaxInteger});
  return in.result(std::move(edit));
}

void write_edit(const Edit& edit, nlohmann::ordered_json& out) {
  if (edit.layer != 0) out["layer"] = edit.layer;
  out["stencil"] = name(edit.stencil);
  out["fill"] = edit.fill;
  if (edit.is_path) {
    auto& path = out["path"] = nlohmann::ordered_json::array();
    for (const MapPoint& point : edit.path) path.push_back({point.x, point.y});
  } else {
    out["x"] = edit.path.at(0).x;
    out["y"] = edit.path.at(0).y;
  }
  out["radius"] = edit.radius;
  if (edit.stroke) out["stroke"] = *edit.stroke;
}

}  // namespace earthwork::protocol
