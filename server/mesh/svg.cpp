#include "server/mesh/svg.hpp"

#include <algorithm>
#include <cstdint>

#include "server/mesh/mesher.hpp"

namespace earthwork::mesh {
namespace {

constexpr std::int64_t kUnit = voxel::kEdgeSteps / 64;  // mesh steps in a user unit

/// A step count as user units, three digits after the point: written by hand, so that no library
/// decides how a number looks.
std::string units(std::int64_t steps) {
  const std::int64_t thousandths = steps * 1000 / kUnit, whole = std::abs(thousandths);
  const std::string digits = std::to_string(whole % 1000 + 1000).substr(1);
  return (thousandths < 0 ? "-" : "") + std::to_string(whole / 1000) + "." + digits;
}

struct Place {
  std::int64_t x, y;  // in mesh steps of the map
};

std::string pair(Place p) { return units(p.x) + " " + units(-p.y); }

class Picture {
 public:
  void chunk(const voxel::ChunkKey& key, int resolution, const ChunkMesh& mesh) {
    const std::int64_t side = std::int64_t{resolution} * voxel::kEdgeSteps;
    const Place origin{key.x * side, key.y * side};
    const auto at = [&](std::uint16_t v) {
      return Place{origin.x + mesh.vertices[v].x, origin.y + mesh.vertices[v].y};
    };
    rims_ +=
        "M" + pair(origin) + " h" + units(side) + " v" + units(-side) + " h" + units(-side) + "z\n";
    for (std::size_t k = 0; k + 2 < mesh.triangles.size(); k += 3) {
      surface_ += "M" + pair(at(mesh.triangles[k])) + " L" + pair(at(mesh.triangles[k + 1])) + " " +
                  pair(at(mesh.triangles[k + 2])) + "z\n";
    }
    for (const Section& section : mesh.sections) {
      walls_ += "M" + pair(at(section.a)) + " L" + pair(at(section.b)) + "\n";
      normal(at(section.a), section.normal_a);
      normal(at(section.b), section.normal_b);
    }
    grow(origin);
    grow({origin.x + side + voxel::kEdgeSteps, origin.y + side + voxel::kEdgeSteps});
  }

  std::string text() const {
    const std::int64_t width = std::max<std::int64_t>(high_.x - low_.x, kUnit);
    const std::int64_t height = std::max<std::int64_t>(high_.y - low_.y, kUnit);
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"" + units(low_.x) + " " +
           units(-low_.y - height) + " " + units(width) + " " + units(height) + "\">\n" +
           path("#e8e4d8", "none", 0, rims_) + path("#b9c99a", "#7d8c5f", 1, surface_) +
           path("none", "#5a3d2b", 4, walls_) + path("none", "#c2410c", 2, normals_) +
           path("none", "#9aa5b1", 1, rims_) + "</svg>\n";
  }

 private:
  static std::string path(const char* fill, const char* stroke, int width, const std::string& d) {
    if (d.empty()) return "";
    return std::string("<path fill=\"") + fill + "\" stroke=\"" + stroke + "\" stroke-width=\"" +
           std::to_string(width) + "\" d=\"\n" + d + "\"/>\n";
  }
  void normal(Place at, voxel::Normal n) {
    constexpr std::int64_t kShare = 4;  // drawn a quarter of a voxel long
    const Place end{at.x + n.x / kShare, at.y + n.y / kShare};
    normals_ += "M" + pair(at) + " L" + pair(end) + "\n";
  }
  void grow(Place p) {
    if (first_) low_ = high_ = p;
    first_ = false;
    low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
    high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y)};
  }

  bool first_ = true;
  Place low_{}, high_{};
  std::string rims_, surface_, walls_, normals_;
};

}  // namespace

std::string contour_svg(const voxel::Map& map, int layer, double max_feature_angle) {
  Mesher mesher(max_feature_angle);
  ChunkMesh mesh;
  Picture picture;
  for (const voxel::ChunkKey& key : map.meshed_keys()) {
    if (key.layer != layer) continue;
    mesher.mesh(map.neighbourhood(key), map.grid().resolution, mesh);
    if (!mesh.empty()) picture.chunk(key, map.grid().resolution, mesh);
  }
  return picture.text();
}

}  // namespace earthwork::mesh
