#include "client/bot/load_voxels.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace earthwork::bot {
namespace {

constexpr std::uint64_t kCrossingBytes = 6;

std::int64_t floor_to(double value, std::int64_t unit) {
  const auto units = static_cast<double>(unit);
  return static_cast<std::int64_t>(std::floor(value / units)) * unit;
}

std::int64_t chunk_of(std::int64_t voxel, std::int64_t resolution) {
  return (voxel < 0 ? voxel - resolution + 1 : voxel) / resolution;
}

}  // namespace

VoxelBytes::VoxelBytes(const protocol::MapSettings& settings, const PaintedSquare& square,
                       double radius)
    : voxel_size_(settings.voxel_size), resolution_(settings.chunk_resolution) {
  // A voxel beyond what circles reach: an edge at the border has both its voxels.
  const double margin = radius / voxel_size_ + 2;
  const double left = square.x0 / voxel_size_, low = square.y0 / voxel_size_;
  const double side = square.side / voxel_size_;
  x0_ = floor_to(left - margin, resolution_);
  y0_ = floor_to(low - margin, resolution_);
  width_ = floor_to(left + side + margin, resolution_) + resolution_ - x0_;
  height_ = floor_to(low + side + margin, resolution_) + resolution_ - y0_;
  states_.resize(static_cast<std::size_t>(width_ * height_));
}

bool VoxelBytes::at(std::int64_t x, std::int64_t y) const {
  if (x >= x0_ + width_ || y >= y0_ + height_) return false;
  return states_[static_cast<std::size_t>((y - y0_) * width_ + (x - x0_))];
}

std::uint64_t VoxelBytes::add(const protocol::Edit& edit) {
  const double radius = edit.radius / voxel_size_;
  std::set<std::pair<std::int64_t, std::int64_t>> changed;
  for (const protocol::MapPoint& centre : edit.path) {
    // Voxel i's centre lies at i + 0.5.
    const double x = centre.x / voxel_size_ - 0.5, y = centre.y / voxel_size_ - 0.5;
    const auto last_y = static_cast<std::int64_t>(std::floor(y + radius));
    for (auto j = static_cast<std::int64_t>(std::ceil(y - radius)); j <= last_y; ++j) {
      const double dy = static_cast<double>(j) - y;
      const double half = std::sqrt(std::max(0.0, radius * radius - dy * dy));
      const auto last_x = static_cast<std::int64_t>(std::floor(x + half));
      for (auto i = static_cast<std::int64_t>(std::ceil(x - half)); i <= last_x; ++i) {
        auto state = states_[static_cast<std::size_t>((j - y0_) * width_ + (i - x0_))];
        if (state == edit.fill) continue;
        state = edit.fill;
        changed.emplace(chunk_of(i, resolution_), chunk_of(j, resolution_));
      }
    }
  }
  std::uint64_t bytes = 0;
  for (const auto& [chunk_x, chunk_y] : changed) bytes += chunk_bytes(chunk_x, chunk_y);
  return bytes;
}

std::uint64_t VoxelBytes::chunk_bytes(std::int64_t chunk_x, std::int64_t chunk_y) const {
  std::uint64_t crossings = 0;
  for (std::int64_t y = chunk_y * resolution_; y < (chunk_y + 1) * resolution_; ++y)
    for (std::int64_t x = chunk_x * resolution_; x < (chunk_x + 1) * resolution_; ++x) {
      const bool here = at(x, y);
      crossings += here != at(x + 1, y) ? 1 : 0;
      crossings += here != at(x, y + 1) ? 1 : 0;
    }
  return static_cast<std::uint64_t>(resolution_ * resolution_ / 8) + crossings * kCrossingBytes;
}

double mean_voxel_bytes(const protocol::MapSettings& settings, const PaintedSquare& square,
                        double radius, std::uint64_t seed, std::size_t walks, std::uint64_t edits) {
  if (edits == 0 || walks == 0) return 0;
  std::vector<BrushWalk> brushes;
  for (std::size_t i = 0; i < walks; ++i) brushes.emplace_back(square, radius, seed + i);
  VoxelBytes voxels(settings, square, radius);
  std::uint64_t bytes = 0;
  for (std::uint64_t i = 0; i < edits; ++i) bytes += voxels.add(brushes[i % walks].next());
  return static_cast<double>(bytes) / static_cast<double>(edits);
}

}  // namespace earthwork::bot
