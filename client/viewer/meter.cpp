#include "client/viewer/meter.hpp"

#include <algorithm>

namespace earthwork::viewer {
namespace {

constexpr std::size_t kMost = 1000;

}  // namespace

void Meter::drawn(Time ended, std::size_t triangles) {
  triangles_ = triangles;
  ends_.push_back(ended);
  while (ends_.size() > kMost || ended - ends_.front() >= std::chrono::seconds(1))
    ends_.pop_front();
}

double Meter::fps(Time now) const {
  return static_cast<double>(std::count_if(ends_.begin(), ends_.end(), [&](const Time& end) {
    return now - end < std::chrono::seconds(1);
  }));
}

}  // namespace earthwork::viewer
