// What the server says, and what a viewer asks of it.
#include <algorithm>
#include <utility>

#include "client/viewer/viewer_state.hpp"
#include "protocol/chunk_record.hpp"

namespace earthwork::viewer {

void Viewer::State::joined(const protocol::Joined& joined, link::Joining how) {
  const bool same_map = settings && how == link::Joining::again;
  if (!same_map) enter_map(joined);
  take(protocol::SettingsChanged{.seq = joined.seq, .settings = joined.settings});
  if (std::exchange(broken, false)) meshes = scene::Scene();
  meshes.join(protocol::parse_hex(joined.epoch).value_or(0), joined.seq);
  people.join(joined.users, session.id());
  chat.join(session.id());
  teller.forget();
  people_stale = dirty = true;
  // The same view as before is said again by the session.
  if (!ask_view()) meshes.look(asker.last(), asker.rect(), *settings);
}

/// Another map than before, or the first.
void Viewer::State::enter_map(const protocol::Joined& joined) {
  const bool first = !settings;
  settings = joined.settings;
  epoch = joined.epoch;
  hidden.reset();
  painter.cancel();
  meshes = scene::Scene();
  asker.forget();
  chat.clear();
  chat_stale = true;
  if (first)
    pilot.start(*settings, std::exchange(first_place, std::nullopt));
  else
    pilot.camera().set_voxel_size(settings->voxel_size);
}

void Viewer::State::leave_map() {
  settings.reset();
  epoch.clear();
  hidden.reset();
  painter.cancel();
  meshes = scene::Scene();
  asker.forget();
  people.clear();
  chat.clear();
  teller.forget();
  first_place.reset();
  people_stale = chat_stale = dirty = true;
}

std::optional<protocol::Have> Viewer::State::have() { return meshes.have(); }

void Viewer::State::told(const protocol::ServerMessage& message) {
  if (const auto* changed = std::get_if<protocol::SettingsChanged>(&message)) {
    take(*changed);
  } else if (const auto* caught_up = std::get_if<protocol::CaughtUp>(&message)) {
    take(*caught_up);
  } else if (const auto* presence = std::get_if<protocol::Presence>(&message)) {
    take(*presence);
  } else if (const auto* said = std::get_if<protocol::ChatLines>(&message)) {
    chat.take(*said);
    chat_stale = true;
  } else if (const auto* rejected = std::get_if<protocol::Rejected>(&message)) {
    // Others are of no interest: a cursor that could not be, say.
    if (rejected->id == kChatId)
      notices.add(Notices::Kind::rejected, "Not said: " + rejected->failure.detail, {}, now);
  }
}

/// Only layers ever change.
void Viewer::State::take(const protocol::SettingsChanged& changed) {
  const auto& layers = changed.settings.layers;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const bool was_there = i < settings->layers.size();
    if (was_there && (settings->layers[i].bottom != layers[i].bottom ||
                      settings->layers[i].top != layers[i].top))
      raised.set(i);
  }
  settings->layers = layers;
  held.brush.layer =
      std::min(held.brush.layer, static_cast<std::uint32_t>(settings->layers.size() - 1));
  dirty = true;
}

void Viewer::State::take(const protocol::CaughtUp& caught_up) {
  meshes.catch_up(caught_up.n, caught_up.seq);
  if (caught_up.n != asker.last()) return;
  if (chat.caught_up()) chat_stale = true;
  pilot.caught_up(*settings, meshes.chunks());
  const protocol::MapRect known = asker.rect(), seen = pilot.wanted(*settings);
  if (known.x0 <= seen.x0 && known.y0 <= seen.y0 && seen.x1 <= known.x1 && seen.y1 <= known.y1)
    pilot.rest();
}

void Viewer::State::take(const protocol::Presence& presence) {
  people.take(presence);
  people_stale = true;
  if (presence.all || !presence.cursors.empty() || !presence.left.empty()) dirty = true;
}

protocol::Result<void> Viewer::State::shown(std::vector<protocol::FrameEvent>& events,
                                            std::size_t message_bytes) {
  auto taken = meshes.take(events, message_bytes);
  broken = !taken;
  return taken;
}

void Viewer::State::answered(const std::vector<link::Answer>& answers) {
  painter.take(answers, now);
}

bool Viewer::State::ask_view() {
  const auto view =
      asker.ask(pilot.wanted(*settings), pilot.camera().place().target, *settings, now);
  if (!view) return false;
  meshes.look(view->n, view->rect, *settings);
  session.look(*view);
  return true;
}

/// Tells the others where one points, if it is time to. Who follows somebody sees what they see:
/// told with the margin around it, it would grow without end where two follow each other.
void Viewer::State::point() {
  std::optional<protocol::Brush> brush;
  const auto at = aim();
  if (held.tool == Tool::paint)
    brush = {.stencil = held.brush.stencil,
             .radius = held.brush.radius_voxels * settings->voxel_size,
             .fill = held.brush.fill,
             .layer = held.brush.layer};
  const People::Person* followed = people.find(pilot.followed());
  const protocol::MapRect view =
      followed && followed->view ? *followed->view : pilot.camera().seen(0, 0);
  const auto cursor = cursor_of(at, brush, view, *settings);
  if (teller.tell(cursor, now)) static_cast<void>(session.say(cursor));
}

}  // namespace earthwork::viewer
