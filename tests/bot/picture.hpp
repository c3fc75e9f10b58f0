// Pictures for tests: written as rows of text, or random.
#pragma once

#include <rapidcheck.h>

#include <string_view>
#include <vector>

#include "client/bot/bitmap.hpp"

namespace earthwork::bot {

/// '#' is set; all rows are of one length.
inline Bitmap picture(const std::vector<std::string_view>& rows) {
  Bitmap out(static_cast<int>(rows.front().size()), static_cast<int>(rows.size()));
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x)
      out.set(x, y, rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] == '#');
  return out;
}

/// Up to 40 x 40: a few rectangles set or cleared one over the other, and specks.
inline rc::Gen<Bitmap> any_picture() {
  return rc::gen::exec([] {
    const auto up_to = [](int n) { return *rc::gen::inRange(0, n); };
    Bitmap out(1 + up_to(40), 1 + up_to(40));
    for (int shapes = up_to(12); shapes > 0; --shapes) {
      const int x0 = up_to(out.width()), y0 = up_to(out.height());
      const int x1 = x0 + up_to(out.width() - x0), y1 = y0 + up_to(out.height() - y0);
      const bool value = up_to(3) != 0;
      for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) out.set(x, y, value);
    }
    for (int specks = up_to(20); specks > 0; --specks) {
      const int x = up_to(out.width()), y = up_to(out.height());
      out.set(x, y, !out.at(x, y));
    }
    return out;
  });
}

}  // namespace earthwork::bot
