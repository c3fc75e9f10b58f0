/// What panels show. Parts of it change at different times; each is handed out when it did, and at
/// first. In the page a part is a JSON object under its name here.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "client/scene/brush.hpp"
#include "client/scene/camera.hpp"
#include "client/viewer/panel_command.hpp"
#include "protocol/messages.hpp"

namespace earthwork::viewer {

/// "connection": {"state": "connecting" | "joined" | "lost" | "ended", "words", "retry_ms"?,
/// "key"?, "session"?}.
struct ConnectionPart {
  enum class State : std::uint8_t {
    connecting,  ///< For the first time.
    joined,
    lost,   ///< What is drawn stays, and another connection is tried.
    ended,  ///< For good: `words` say why.
  };
  State state = State::connecting;
  std::string words;                     ///< A sentence for people.
  std::optional<std::int64_t> retry_ms;  ///< Until the next attempt, as of when it was handed out.
  std::string key, session;              ///< As of the last welcome.
  friend bool operator==(const ConnectionPart&, const ConnectionPart&) = default;
};

/// "map": {"name", "epoch", "settings": as in `joined`, "hidden": [layer]}.
struct MapPart {
  std::string name, epoch;
  protocol::MapSettings settings;
  std::vector<std::uint32_t> hidden;
  friend bool operator==(const MapPart&, const MapPart&) = default;
};

/// "brush": {"tool", "stencil", "fill", "radius", "layer", "snap"}.
struct BrushPart {
  Tool tool = Tool::paint;
  scene::BrushSettings brush;
  friend bool operator==(const BrushPart&, const BrushPart&) = default;
};

/// "people": {"people": [{"session", "name", "color", "me", "view" (can be followed),
/// "followed"}]}.
struct PeoplePart {
  struct Person {
    std::string session, name, color;
    bool me = false, has_view = false, followed = false;
    friend bool operator==(const Person&, const Person&) = default;
  };
  std::vector<Person> people;  ///< Oneself first, then in order of their names.
  friend bool operator==(const PeoplePart&, const PeoplePart&) = default;
};

/// "chat": {"lines": [{"n", "time", "name", "color", "text", "mine"}], "known"}: the last 100.
struct ChatPart {
  std::vector<protocol::ChatLine> lines;
  std::vector<bool> mine;  ///< Of each: one said it oneself.
  bool known = false;      ///< What was said before one came is there; what follows is new.
  friend bool operator==(const ChatPart&, const ChatPart&) = default;
};

/// "status": {"seq", "latency_ms"?, "fps", "bytes", "chunks", "triangles", "unanswered",
/// "caught_up"}; at most four times a second.
struct StatusPart {
  std::uint64_t seq = 0, bytes = 0, chunks = 0, triangles = 0, unanswered = 0;
  std::optional<double> latency_ms;  ///< Of the last ping.
  double fps = 0;                    ///< Pictures drawn in the last second.
  bool caught_up = false;            ///< All that is in view is there.
  friend bool operator==(const StatusPart&, const StatusPart&) = default;
};

/// "camera": {"x", "y", "zoom", "yaw", "tilt"}; at most four times a second.
struct CameraPart {
  scene::Camera::Place place;
  friend bool operator==(const CameraPart&, const CameraPart&) = default;
};

/// "notices": {"notices": [{"n", "kind": "rejected" | "lost" | "said", "words", "x"?, "y"?}]}: the
/// last 20 things that went wrong or happened, newest last.
struct NoticesPart {
  struct Notice {
    enum class Kind : std::uint8_t { rejected, lost, said };
    std::uint64_t n = 0;  ///< 1, 2, 3 ...
    Kind kind = Kind::said;
    std::string words;
    std::optional<protocol::MapPoint> at;  ///< Where on the map.
    friend bool operator==(const Notice&, const Notice&) = default;
  };
  std::vector<Notice> notices;
  friend bool operator==(const NoticesPart&, const NoticesPart&) = default;
};

/// "shortcuts": {"shortcuts": [{"keys": ["f"], "does": "Fill"}]}: what keys do, once, for the `?`
/// dialog. Keys are as in KeyEvent.
struct ShortcutsPart {
  struct Shortcut {
    std::vector<std::string> keys;  ///< Each of them does it.
    std::string does;
    friend bool operator==(const Shortcut&, const Shortcut&) = default;
  };
  std::vector<Shortcut> shortcuts;
  friend bool operator==(const ShortcutsPart&, const ShortcutsPart&) = default;
};

struct PanelChanges {
  std::optional<ConnectionPart> connection;
  std::optional<MapPart> map;
  std::optional<BrushPart> brush;
  std::optional<PeoplePart> people;
  std::optional<ChatPart> chat;
  std::optional<StatusPart> status;
  std::optional<CameraPart> camera;
  std::optional<NoticesPart> notices;
  std::optional<ShortcutsPart> shortcuts;
};

/// One object with the parts that are there.
[[nodiscard]] std::string write(const PanelChanges& changes);

/// Something to be written beside a place: {"kind": "person" | "notice", "text", "color", "x", "y"}
/// in CSS pixels.
struct Label {
  enum class Kind : std::uint8_t { person, notice };
  Kind kind = Kind::person;
  std::string text, color;
  scene::ScreenPoint at;
  friend bool operator==(const Label&, const Label&) = default;
};
/// A JSON array.
[[nodiscard]] std::string write(const std::vector<Label>& labels);

}  // namespace earthwork::viewer
