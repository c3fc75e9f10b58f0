#include "client/viewer/web/figures.hpp"

#include <nlohmann/json.hpp>

namespace earthwork::viewer {
namespace {

void keep(std::vector<double>& list, double value) {
  if (list.size() == Figures::kKept) list.erase(list.begin());
  list.push_back(value);
}

}  // namespace

void Figures::press(double at_ms) {
  if (!pressed_ms_) pressed_ms_ = at_ms;
}

void Figures::draw(const Drawn& drawn) {
  ++frames_;
  last_ = drawn;
  keep(draw_ms_, drawn.ended_ms - drawn.began_ms);
  if (!first_picture_ms_ && drawn.triangles > 0) first_picture_ms_ = drawn.ended_ms;
  if (!whole_picture_ms_ && drawn.whole) whole_picture_ms_ = drawn.ended_ms;
  if (pressed_ms_ && drawn.meshes_changed) {
    keep(input_to_picture_ms_, drawn.ended_ms - *pressed_ms_);
    pressed_ms_.reset();
  }
}

std::string Figures::write(std::size_t heap_bytes) const {
  nlohmann::ordered_json out{{"frames", frames_},    {"input_to_picture_ms", input_to_picture_ms_},
                             {"draw_ms", draw_ms_},  {"triangles", last_.triangles},
                             {"draws", last_.draws}, {"heap_bytes", heap_bytes}};
  if (first_picture_ms_) out["first_picture_ms"] = *first_picture_ms_;
  if (whole_picture_ms_) out["whole_picture_ms"] = *whole_picture_ms_;
  return out.dump();
}

}  // namespace earthwork::viewer
