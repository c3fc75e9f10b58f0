/// A part of the panels as it was last handed out, so that it is handed out again only when it
/// differs.
#pragma once

#include <optional>
#include <utility>

namespace earthwork::viewer {

template <class Part>
class ShownPart {
 public:
  /// The part, if it is not the one that is shown; it is from now on.
  [[nodiscard]] std::optional<Part> offer(Part part) {
    if (shown_ == part) return std::nullopt;
    shown_ = std::move(part);
    return shown_;
  }
  [[nodiscard]] bool shows(const Part& part) const { return shown_ == part; }

 private:
  std::optional<Part> shown_;
};

}  // namespace earthwork::viewer
