/// The words that stand beside places of a map: names of people, and what went wrong there.
#pragma once

#include <vector>

#include "client/scene/camera.hpp"
#include "client/viewer/panel_state.hpp"
#include "client/viewer/people.hpp"
#include "protocol/settings.hpp"

namespace earthwork::viewer {

/// Names of people at their cursors, and words of notices at their places, as far as they are on
/// the screen.
[[nodiscard]] std::vector<Label> labels_of(const People& people,
                                           const std::vector<const NoticesPart::Notice*>& notices,
                                           const scene::Camera& camera,
                                           const protocol::MapSettings& settings);

}  // namespace earthwork::viewer
