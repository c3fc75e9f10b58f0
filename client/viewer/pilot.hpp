/// Where the camera goes, and on whose behalf: a person's own moves, all of the map, or whom they
/// follow.
#pragma once

#include <optional>
#include <string>

#include "client/scene/camera.hpp"
#include "client/scene/scene.hpp"
#include "client/viewer/panel_command.hpp"
#include "protocol/chunk_range.hpp"
#include "protocol/settings.hpp"

namespace earthwork::viewer {

class Pilot {
 public:
  [[nodiscard]] const scene::Camera& camera() const { return camera_; }
  /// To be moved by hand; `moved` is to be called afterwards, if it was.
  [[nodiscard]] scene::Camera& camera() { return camera_; }
  /// A move of one's own: nobody is followed any more.
  void moved();
  void resize(scene::ScreenSize size);

  /// A map is there for the first time. Without a place the camera shows all of it: its bounds, or
  /// what is found from 0 on, as it comes to be known.
  void start(const protocol::MapSettings& settings, const std::optional<scene::Camera::Place>& at);
  /// Shows all of the map: its bounds, or where these chunks are and what is found beside them.
  void fit(const protocol::MapSettings& settings, const scene::Scene::Chunks& chunks);
  /// All that was asked for has arrived: shows all of it, if that is what the camera shows.
  void caught_up(const protocol::MapSettings& settings, const scene::Scene::Chunks& chunks);
  /// What the camera shows now is there already: nothing more is to be found.
  void rest() { rounds_ = 0; }
  /// Any other action than fit.
  void act(const MoveCamera& move);

  /// The camera goes with them, from their next view on; an empty session: with nobody.
  void follow(std::string session);
  [[nodiscard]] const std::string& followed() const { return followed_; }
  /// Whom one follows sees this now.
  void lead(const protocol::MapRect& view);

  /// What has to be there to be drawn, and to find out how large the map is.
  [[nodiscard]] protocol::MapRect wanted(const protocol::MapSettings& settings) const;

 private:
  void show(const protocol::MapRect& rect);

  scene::Camera camera_;
  std::optional<protocol::MapRect> shown_;  // what the camera fits; none after a move of one's own
  std::optional<protocol::MapRect> found_;  // where there is something, while it is looked for
  int rounds_ = 0;                          // to look for more
  std::string followed_;
};

/// The least rectangle around all meshes; none without meshes.
[[nodiscard]] std::optional<protocol::MapRect> extent_of(const scene::Scene::Chunks& chunks,
                                                         const protocol::MapSettings& settings);

}  // namespace earthwork::viewer
