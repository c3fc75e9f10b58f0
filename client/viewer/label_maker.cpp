#include "client/viewer/label_maker.hpp"

#include <string>

#include "client/viewer/picture_maker.hpp"

namespace earthwork::viewer {
namespace {

constexpr const char* kWarning = "#c0392b";

bool on_screen(scene::ScreenPoint at, scene::ScreenSize size) {
  return 0 <= at.x && at.x <= size.width && 0 <= at.y && at.y <= size.height;
}

}  // namespace

std::vector<Label> labels_of(const People& people,
                             const std::vector<const NoticesPart::Notice*>& notices,
                             const scene::Camera& camera, const protocol::MapSettings& settings) {
  std::vector<Label> labels;
  const auto add_label = [&](Label::Kind kind, const std::string& text, const std::string& color,
                             protocol::MapPoint point, double height) {
    const auto at = camera.screen({point.x, point.y, height});
    if (at && on_screen(*at, camera.size()))
      labels.push_back({.kind = kind, .text = text, .color = color, .at = *at});
  };
  for (const auto& [session, person] : people.persons()) {
    if (!person.cursor || people.is_me(session)) continue;
    add_label(Label::Kind::person, person.user.name, person.user.color, *person.cursor,
              height_of(person.brush ? person.brush->layer : 0, settings));
  }
  for (const NoticesPart::Notice* notice : notices)
    if (notice->at) add_label(Label::Kind::notice, notice->words, kWarning, *notice->at, 0);
  return labels;
}

}  // namespace earthwork::viewer
