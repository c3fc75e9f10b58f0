#include "tests/transcripts/normal_form.hpp"

#include <nlohmann/json.hpp>

namespace earthwork::transcripts {

using nlohmann::ordered_json;
using protocol::ChunkMesh;
using protocol::ChunkRecord;

namespace {

std::string pair(std::int64_t x, std::int64_t y) {
  return std::to_string(x) + "," + std::to_string(y);
}

std::string vertices(const ChunkMesh& mesh) {
  std::string out = "  vertices";
  for (const auto& v : mesh.vertices) out += " " + pair(v.x, v.y);
  return out;
}

std::string triangles(const ChunkMesh& mesh) {
  std::string out = "  triangles";
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    out += (i % 3 == 0 ? " " : "-") + std::to_string(mesh.triangles[i]);
  return out;
}

std::string sections(const ChunkMesh& mesh) {
  std::string out = "  sections";
  for (const auto& s : mesh.sections)
    out += " " + std::to_string(s.a) + "(" + pair(s.normal_a.x, s.normal_a.y) + ")-" +
           std::to_string(s.b) + "(" + pair(s.normal_b.x, s.normal_b.y) + ")";
  return out;
}

}  // namespace

std::optional<std::string> NormalForm::text(std::string_view message) {
  auto json = ordered_json::parse(message, nullptr, false);
  if (json.is_discarded()) return "not JSON: " + std::string(message);
  if (!show_presence && json.is_object() && json.value("type", "") == "presence")
    return std::nullopt;
  walk(json);
  return json.dump();
}

void NormalForm::walk(ordered_json& json) {
  for (auto& [key, value] : json.items()) replace(key, value);
}

void NormalForm::replace(const std::string& key, ordered_json& value) {
  if (key == "limits" && !show_limits)
    value = "$limits";
  else if (key == "time")
    value = "$time";
  else if (key == "left" && value.is_array())
    for (auto& session : value) replace("session", session);
  else if (value.is_string() &&
           (key == "session" || key == "key" || key == "author" || key == "epoch"))
    value = name_of(key, value.get<std::string>());
  else if (value.is_structured())
    walk(value);
}

const std::string& NormalForm::name_of(const std::string& kind, const std::string& value) {
  std::string& name = names_[value];
  if (name.empty()) name = "$" + kind + std::to_string(++counts_[kind]);
  return name;
}

std::vector<std::string> NormalForm::frame(const protocol::FrameEvent& event) {
  if (const auto* begin = std::get_if<protocol::GroupBegin>(&event))
    return {"group seq=" + std::to_string(begin->seq) + " view=" + std::to_string(begin->view) +
            " epoch=" + name_of("epoch", protocol::hex(begin->epoch))};
  if (const auto* end = std::get_if<protocol::GroupEnd>(&event))
    return {"end seq=" + std::to_string(end->seq)};
  if (const auto* delta = std::get_if<protocol::ChunkDelta>(&event))
    return {"delta layer=" + std::to_string(delta->key.layer) +
            " chunk=" + pair(delta->key.x, delta->key.y) + "," + std::to_string(delta->key.z) +
            " revision=" + std::to_string(delta->revision) +
            " base=" + std::to_string(delta->base_revision)};
  return record(std::get<ChunkRecord>(event));
}

std::vector<std::string> NormalForm::record(const ChunkRecord& record) const {
  const auto& [layer, x, y, z] = record.key;
  const std::string who = " layer=" + std::to_string(layer) + " chunk=" + pair(x, y) + "," +
                          std::to_string(z) + " revision=" + std::to_string(record.revision);
  if (record.removed) return {"removed" + who};
  const ChunkMesh& mesh = record.mesh;
  std::vector<std::string> out{"mesh" + who + " vertices=" + std::to_string(mesh.vertices.size()) +
                               " triangles=" + std::to_string(mesh.triangles.size() / 3) +
                               " sections=" + std::to_string(mesh.sections.size()) +
                               " hash=" + protocol::hex(protocol::mesh_hash(mesh))};
  if (show_meshes) out.insert(out.end(), {vertices(mesh), triangles(mesh), sections(mesh)});
  return out;
}

std::string NormalForm::filled_in(std::string text) const {
  for (const auto& [value, name] : names_)
    for (auto at = text.find(name); at != std::string::npos; at = text.find(name, at + 1))
      text.replace(at, name.size(), value);
  return text;
}

}  // namespace earthwork::transcripts
