// Panels as JSON: what the page's JavaScript reads.
#include "client/viewer/panel_state.hpp"

#include <nlohmann/json.hpp>

namespace earthwork::viewer {
namespace {

using nlohmann::ordered_json;

ordered_json part(const ConnectionPart& connection) {
  constexpr const char* kStates[] = {"connecting", "joined", "lost", "ended"};
  ordered_json out{{"state", kStates[static_cast<std::size_t>(connection.state)]},
                   {"words", connection.words}};
  if (connection.retry_ms) out["retry_ms"] = *connection.retry_ms;
  if (!connection.key.empty()) out["key"] = connection.key;
  if (!connection.session.empty()) out["session"] = connection.session;
  return out;
}

ordered_json part(const MapPart& map) {
  return {{"name", map.name},
          {"epoch", map.epoch},
          {"settings", protocol::write_settings(map.settings)},
          {"hidden", map.hidden}};
}

ordered_json part(const BrushPart& held) {
  constexpr const char* kTools[] = {"paint", "move"};
  constexpr const char* kSnaps[] = {"none", "centres", "lines"};
  return {{"tool", kTools[static_cast<std::size_t>(held.tool)]},
          {"stencil", protocol::name(held.brush.stencil)},
          {"fill", held.brush.fill},
          {"radius", held.brush.radius_voxels},
          {"layer", held.brush.layer},
          {"snap", kSnaps[static_cast<std::size_t>(held.brush.snap)]}};
}

ordered_json part(const PeoplePart& people) {
  auto list = ordered_json::array();
  for (const auto& person : people.people)
    list.push_back({{"session", person.session},
                    {"name", person.name},
                    {"color", person.color},
                    {"me", person.me},
                    {"view", person.has_view},
                    {"followed", person.followed}});
  return {{"people", std::move(list)}};
}

ordered_json part(const ChatPart& chat) {
  auto lines = ordered_json::array();
  for (std::size_t i = 0; i < chat.lines.size(); ++i) {
    const protocol::ChatLine& line = chat.lines[i];
    lines.push_back({{"n", line.n},
                     {"time", line.time_ms},
                     {"name", line.name},
                     {"color", line.color},
                     {"text", line.text},
                     {"mine", bool(chat.mine.at(i))}});
  }
  return {{"lines", std::move(lines)}, {"known", chat.known}};
}

ordered_json part(const StatusPart& status) {
  ordered_json out{{"seq", status.seq}};
  if (status.latency_ms) out["latency_ms"] = *status.latency_ms;
  out.update({{"fps", status.fps},
              {"bytes", status.bytes},
              {"chunks", status.chunks},
              {"triangles", status.triangles},
              {"unanswered", status.unanswered},
              {"caught_up", status.caught_up}});
  return out;
}

ordered_json part(const CameraPart& camera) {
  const auto& place = camera.place;
  return {{"x", place.target.x},
          {"y", place.target.y},
          {"zoom", place.zoom},
          {"yaw", place.yaw},
          {"tilt", place.tilt}};
}

ordered_json part(const NoticesPart& notices) {
  constexpr const char* kKinds[] = {"rejected", "lost", "said"};
  auto list = ordered_json::array();
  for (const auto& notice : notices.notices) {
    ordered_json one{{"n", notice.n},
                     {"kind", kKinds[static_cast<std::size_t>(notice.kind)]},
                     {"words", notice.words}};
    if (notice.at) {
      one["x"] = notice.at->x;
      one["y"] = notice.at->y;
    }
    list.push_back(std::move(one));
  }
  return {{"notices", std::move(list)}};
}

ordered_json part(const ShortcutsPart& shortcuts) {
  auto list = ordered_json::array();
  for (const auto& shortcut : shortcuts.shortcuts)
    list.push_back({{"keys", shortcut.keys}, {"does", shortcut.does}});
  return {{"shortcuts", std::move(list)}};
}

template <class Part>
void add(ordered_json& out, const char* name, const std::optional<Part>& changed) {
  if (changed) out[name] = part(*changed);
}

}  // namespace

std::string write(const PanelChanges& changes) {
  auto out = ordered_json::object();
  add(out, "connection", changes.connection);
  add(out, "map", changes.map);
  add(out, "brush", changes.brush);
  add(out, "people", changes.people);
  add(out, "chat", changes.chat);
  add(out, "status", changes.status);
  add(out, "camera", changes.camera);
  add(out, "notices", changes.notices);
  add(out, "shortcuts", changes.shortcuts);
  return out.dump();
}

std::string write(const std::vector<Label>& labels) {
  constexpr const char* kKinds[] = {"person", "notice"};
  auto out = ordered_json::array();
  for (const Label& label : labels)
    out.push_back({{"kind", kKinds[static_cast<std::size_t>(label.kind)]},
                   {"text", label.text},
                   {"color", label.color},
                   {"x", label.at.x},
                   {"y", label.at.y}});
  return out.dump();
}

}  // namespace earthwork::viewer
