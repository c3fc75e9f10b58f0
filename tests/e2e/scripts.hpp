// Edit scripts for bots, the same for the same seed.
#pragma once

#include <nlohmann/json.hpp>
#include <random>
#include <string>

namespace earthwork::e2e {

/// Circles with their centres between -`reach` and `reach`, as a script.
inline std::string circles(int count, int reach, unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(random);
  };
  std::string out;
  for (int i = 0; i < count; ++i)
    out += nlohmann::json{{"stencil", "circle"},
                          {"fill", between(0, 2) != 0},
                          {"x", between(-16 * reach, 16 * reach) / 16.0},
                          {"y", between(-16 * reach, 16 * reach) / 16.0},
                          {"radius", between(16, 64) / 16.0}}
               .dump() +
           "\n";
  return out;
}

}  // namespace earthwork::e2e
