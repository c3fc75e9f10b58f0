#include "client/viewer/viewer_state.hpp"

#include <algorithm>
#include <utility>

#include "client/viewer/label_maker.hpp"
#include "client/viewer/picture_maker.hpp"

namespace earthwork::viewer {

using protocol::ChunkKey;
using scene::ScreenPoint;

Viewer::State::State(Shell& the_shell, ViewerOptions options, Time start)
    : shell(the_shell),
      now(start),
      first_place(options.place),
      session(the_shell, *this,
              {.map = std::move(options.map),
               .hello = std::move(options.hello),
               .last_id = options.last_id,
               .seed = options.seed},
              start),
      painter([this](const protocol::Edit& edit) { return session.edit(edit); }, notices,
              options.last_id) {}

void Viewer::State::resize(scene::ScreenSize size, double ratio) {
  if (std::exchange(pixel_ratio, ratio) != ratio) dirty = true;
  pilot.resize(size);
}

// The plane that is painted on is the top of the brush's layer: there the outline lies, and there
// it follows the pointer exactly, however the camera is tilted.
double Viewer::State::plane() const {
  return settings ? height_of(held.brush.layer, *settings) : 0;
}

std::optional<protocol::MapPoint> Viewer::State::aim() const {
  if (!settings || !hand.over()) return std::nullopt;
  return pilot.camera().ground(*hand.over(), plane());
}

void Viewer::State::take_pointer(const PointerEvent& event) {
  take(hand.pointer(event, {pilot.camera(), held.tool, plane()}, now));
}

void Viewer::State::take_wheel(const WheelEvent& event) { take(hand.wheel(event, pilot.camera())); }

void Viewer::State::take(const HandOutcome& outcome) {
  if (outcome.camera_moved) pilot.moved();
  if (outcome.radius_steps != 0) grow_brush(outcome.radius_steps);
  for (const BrushAct& act : outcome.brush) {
    switch (act.kind) {
      case BrushAct::Kind::begin:
        if (settings) painter.begin(held.brush, *settings, act.at, now);
        break;
      case BrushAct::Kind::draw:
        painter.draw_to(act.at, now);
        break;
      case BrushAct::Kind::end:
        painter.end(now);
        break;
      case BrushAct::Kind::cancel:
        painter.cancel();
        break;
    }
  }
}

Viewer::State::Sight Viewer::State::sight() const {
  Sight out{.place = pilot.camera().place(),
            .size = pilot.camera().size(),
            .held = held,
            .aim = {},
            .notice = notices.last()};
  if (held.tool == Tool::paint) out.aim = aim();
  return out;
}

Viewer::Frame Viewer::State::frame() {
  painter.flush(now);
  drawn = sight();
  drawn_live = session.live();
  dirty = frame_asked = false;
  words_end = notices.due(now);

  Frame out;
  out.picture.camera = pilot.camera();
  out.picture.pixel_ratio = pixel_ratio;
  out.picture.hidden = hidden;
  out.picture.dots_layer = held.brush.layer;
  if (settings) {
    out.picture.settings = *settings;
    add_border(out.picture);
    if (drawn_live) add_cursors(out.picture, people);
    if (drawn->aim) add_own_brush(out.picture, held.brush, *drawn->aim);
  }
  take_changes(out);
  return out;
}

/// A layer whose walls have other ends looks different everywhere.
void Viewer::State::take_changes(Frame& frame) {
  auto changes = meshes.take_changed();
  frame.all = changes.all;
  frame.changed = std::move(changes.keys);
  const auto higher = std::exchange(raised, {});
  if (higher.none() || frame.all) return;
  for (const auto& [key, chunk] : meshes.chunks())
    if (higher.test(static_cast<std::size_t>(key.layer))) frame.changed.push_back(key);
  std::sort(frame.changed.begin(), frame.changed.end());
  frame.changed.erase(std::unique(frame.changed.begin(), frame.changed.end()), frame.changed.end());
}

std::vector<Label> Viewer::State::labels() const {
  if (!settings) return {};
  return labels_of(drawn_live ? people : People{}, notices.shown(now), pilot.camera(), *settings);
}

StatusPart Viewer::State::status() const {
  return {.seq = meshes.seq(),
          .bytes = session.bytes(),
          .chunks = meshes.stats().chunks,
          .triangles = meter.triangles(),
          .unanswered = session.unanswered(),
          .latency_ms = session.latency_ms(),
          .fps = meter.fps(now),
          .caught_up = settings && session.live() && meshes.complete_view() == asker.last()};
}

PanelChanges Viewer::State::panels() {
  PanelChanges out;
  const ConnectionPart connection = session.part(now);
  ConnectionPart lasting = connection;  // apart from the time that is left
  lasting.retry_ms.reset();
  if (panels_shown.connection.offer({lasting, session.retry_at()})) out.connection = connection;
  if (settings) out.map = panels_shown.map.offer(map_part());
  out.brush = panels_shown.brush.offer(held);
  if (std::exchange(people_shown, pilot.followed()) != pilot.followed()) people_stale = true;
  if (std::exchange(people_stale, false))
    out.people = panels_shown.people.offer(people.part(pilot.followed()));
  if (std::exchange(chat_stale, false)) out.chat = panels_shown.chat.offer(chat.part());
  out.notices = panels_shown.notices.offer(notices.part());
  out.shortcuts = panels_shown.shortcuts.offer(shortcuts());
  if (figures_at && now - *figures_at < kPanelsEvery) return out;
  out.status = panels_shown.status.offer(status());
  out.camera = panels_shown.camera.offer({pilot.camera().place()});
  if (out.status || out.camera) figures_at = now;
  return out;
}

MapPart Viewer::State::map_part() const {
  MapPart part{.name = session.map(), .epoch = epoch, .settings = *settings, .hidden = {}};
  for (std::uint32_t layer = 0; layer < settings->layers.size(); ++layer)
    if (hidden.test(layer)) part.hidden.push_back(layer);
  return part;
}

void Viewer::State::settle() {
  follow();
  if (session.live() && settings) {
    ask_view();
    point();
  }
  if (words_end && *words_end <= now) {
    dirty = true;
    words_end.reset();
  }
  ask_frame_if_changed();
  wake_when_due();
}

/// The camera goes with whom one follows, as long as they are there.
void Viewer::State::follow() {
  if (pilot.followed().empty()) return;
  const People::Person* person = people.find(pilot.followed());
  if (!person)
    pilot.follow({});
  else if (person->view)
    pilot.lead(*person->view);
}

void Viewer::State::ask_frame_if_changed() {
  if (frame_asked) return;
  if (!dirty && !meshes.changed() && drawn_live == session.live() && drawn == sight()) return;
  frame_asked = true;
  shell.ask_frame();
}

void Viewer::State::wake_when_due() {
  std::optional<Time> due = session.due();
  const auto earliest = [&](std::optional<Time> at) {
    if (at && (!due || *at < *due)) due = at;
  };
  earliest(words_end);
  if (session.live()) {
    earliest(asker.due());
    earliest(teller.due());
  }
  // Once they are due the next call for panels has them, which follows whatever happens.
  const bool figures_move = meter.fps(now) > 0 || !panels_shown.status.shows(status()) ||
                            !panels_shown.camera.shows({pilot.camera().place()});
  if (figures_at && figures_move && now < *figures_at + kPanelsEvery)
    earliest(*figures_at + kPanelsEvery);
  if (!due || due == woken_at) return;
  woken_at = due;
  shell.wake_after(
      std::chrono::ceil<std::chrono::milliseconds>(std::max(*due - now, Time::duration::zero())));
}

}  // namespace earthwork::viewer
