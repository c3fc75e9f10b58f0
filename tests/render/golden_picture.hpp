// Pictures beside those that are kept. EARTHWORK_UPDATE=1 writes them anew; look at them before you
// commit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace earthwork::viewer {

struct Pixels {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // rows top down

  const std::uint8_t* at(int x, int y) const {
    return &rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x))];
  }
};

/// Pixels that differ by more than 2 of 255 in a channel; all of them when the sizes differ.
std::size_t differing(const Pixels& a, const Pixels& b);

/// tests/render/golden/NAME.png shows the same, but for two pixels in a thousand. What was drawn
/// instead is left in the test's temporary folder.
void expect_golden(const std::string& name, const Pixels& drawn);

}  // namespace earthwork::viewer
