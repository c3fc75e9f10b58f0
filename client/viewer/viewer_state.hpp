/// The parts of a viewer, and how they are joined: what a message, a pointer or a key means to
/// each.
#pragma once

#include <bitset>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "client/viewer/chat_log.hpp"
#include "client/viewer/cursor_teller.hpp"
#include "client/viewer/hand.hpp"
#include "client/viewer/meter.hpp"
#include "client/viewer/notices.hpp"
#include "client/viewer/painter.hpp"
#include "client/viewer/people.hpp"
#include "client/viewer/pilot.hpp"
#include "client/viewer/session.hpp"
#include "client/viewer/shortcuts.hpp"
#include "client/viewer/shown_part.hpp"
#include "client/viewer/view_asker.hpp"
#include "client/viewer/viewer.hpp"

namespace earthwork::viewer {

/// Status and camera are handed to panels no more often.
inline constexpr std::chrono::milliseconds kPanelsEvery{250};

struct Viewer::State final : SessionOwner {
  State(Shell& the_shell, ViewerOptions options, Time start);

  // viewer_session.cpp: what the server says.
  void joined(const protocol::Joined& joined, link::Joining how) override;
  std::optional<protocol::Have> have() override;
  void told(const protocol::ServerMessage& message) override;
  protocol::Result<void> shown(std::vector<protocol::FrameEvent>& events,
                               std::size_t message_bytes) override;
  void answered(const std::vector<link::Answer>& answers) override;
  void take(const protocol::SettingsChanged& changed);
  void take(const protocol::CaughtUp& caught_up);
  void take(const protocol::Presence& presence);
  void enter_map(const protocol::Joined& joined);
  void leave_map();
  /// False when the last view serves, or another one has to wait.
  bool ask_view();
  void point();

  // viewer_command.cpp: what panels and keys ask for.
  using Done = protocol::Result<void>;
  Done run(const UseTool& use);
  Done run(const SetBrush& set);
  Done run(const ShowLayer& show);
  Done run(const ChangeLayer& change);
  Done run(const MoveCamera& move);
  Done run(const StampHere& stamp);
  Done run(const Say& say);
  Done run(const Follow& follow);
  Done run(const OpenMap& open);
  Done run(const BePerson& person);
  Done run(const RetryNow& retry);
  Done check_layer(std::uint32_t layer) const;
  void grow_brush(double voxels);
  void run(BrushKey key);
  void run(StrokeKey key);
  void run(const Shortcut& shortcut);

  // viewer_state.cpp: pointers, pictures, panels.
  void take_pointer(const PointerEvent& event);
  void take_wheel(const WheelEvent& event);
  void resize(scene::ScreenSize size, double ratio);
  void follow();
  void take(const HandOutcome& outcome);
  /// The height that the brush paints at.
  double plane() const;
  /// Where the brush is, on that plane; nowhere before the map is known.
  std::optional<protocol::MapPoint> aim() const;
  Frame frame();
  void take_changes(Frame& frame);
  PanelChanges panels();
  MapPart map_part() const;
  StatusPart status() const;
  std::vector<Label> labels() const;
  /// After each thing that happened: asks, tells and wakes as it needs.
  void settle();
  void ask_frame_if_changed();
  void wake_when_due();

  Shell& shell;
  Time now;                                         // of what is going on
  std::optional<scene::Camera::Place> first_place;  // until the first map is there
  std::optional<protocol::MapSettings> settings;    // of the map, once it is known
  std::string epoch;
  std::bitset<protocol::kMaxLayers> hidden, raised;  // layers; those whose walls have changed
  double pixel_ratio = 1;
  BrushPart held;
  bool broken = false;  // the scene has failed: it begins anew with the next join

  scene::Scene meshes;
  ViewAsker asker;
  Pilot pilot;
  Hand hand;
  People people;
  ChatLog chat;
  Notices notices;
  CursorTeller teller;
  Meter meter;
  Session session;
  Painter painter;

  /// What the last picture was of, apart from what sets `dirty`.
  struct Sight {
    scene::Camera::Place place;
    scene::ScreenSize size;
    BrushPart held;
    std::optional<protocol::MapPoint> aim;
    std::uint64_t notice = 0;  // the last one
    friend bool operator==(const Sight&, const Sight&) = default;
  };
  Sight sight() const;
  std::optional<Sight> drawn;
  bool drawn_live = false;                      // it was drawn while there was a connection
  bool dirty = true;                            // something else that is seen has changed
  bool people_stale = true, chat_stale = true;  // since they were shown in panels
  bool frame_asked = false;
  std::optional<Time> woken_at;   // the shell was told to wake the viewer then
  std::optional<Time> words_end;  // a label of a notice ends then

  struct {
    ShownPart<std::pair<ConnectionPart, std::optional<Time>>> connection;
    ShownPart<MapPart> map;
    ShownPart<BrushPart> brush;
    ShownPart<PeoplePart> people;
    ShownPart<ChatPart> chat;
    ShownPart<StatusPart> status;
    ShownPart<CameraPart> camera;
    ShownPart<NoticesPart> notices;
    ShownPart<ShortcutsPart> shortcuts;
  } panels_shown;
  std::string people_shown;        // whom one followed then
  std::optional<Time> figures_at;  // status and camera were handed out
};

}  // namespace earthwork::viewer
