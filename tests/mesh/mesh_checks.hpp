// What a correct mesh is, said in edges: for the properties over random maps.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "server/mesh/mesher.hpp"

namespace earthwork::mesh {

using Meshes = std::map<voxel::ChunkKey, ChunkMesh>;

/// All meshes that are not empty.
inline Meshes mesh_all(const voxel::Map& map, double max_feature_angle = 135) {
  Mesher mesher(max_feature_angle);
  Meshes meshes;
  for (const voxel::ChunkKey& key : map.meshed_keys()) {
    ChunkMesh mesh;
    mesher.mesh(map.neighbourhood(key), map.grid().resolution, mesh);
    if (!mesh.empty()) meshes[key] = mesh;
  }
  return meshes;
}

/// A point of the map in 1/32768 voxel, and a directed edge between two.
using MapPoint = std::pair<std::int64_t, std::int64_t>;
using DirectedEdge = std::pair<MapPoint, MapPoint>;

inline MapPoint at(const voxel::ChunkKey& key, int resolution, Point p) {
  const std::int64_t side = std::int64_t{resolution} * voxel::kEdgeSteps;
  return {key.x * side + p.x, key.y * side + p.y};
}

/// The surface's triangle edges that have no partner in the other direction, over all chunks.
inline std::multiset<DirectedEdge> outline(const Meshes& meshes, int resolution) {
  std::map<DirectedEdge, int> balance;
  for (const auto& [key, mesh] : meshes) {
    for (std::size_t k = 0; k < mesh.triangles.size(); k += 3) {
      for (std::size_t e = 0; e < 3; ++e) {
        const MapPoint p = at(key, resolution, mesh.vertices[mesh.triangles[k + e]]);
        const MapPoint q = at(key, resolution, mesh.vertices[mesh.triangles[k + (e + 1) % 3]]);
        if (--balance[{q, p}] < 0) ++balance[{q, p}], ++balance[{p, q}];
      }
    }
  }
  std::multiset<DirectedEdge> left;
  for (const auto& [edge, count] : balance) {
    for (int k = 0; k < count; ++k) left.insert(edge);
  }
  return left;
}

inline std::multiset<DirectedEdge> wall_edges(const Meshes& meshes, int resolution) {
  std::multiset<DirectedEdge> edges;
  for (const auto& [key, mesh] : meshes) {
    for (const Section& s : mesh.sections) {
      edges.insert(
          {at(key, resolution, mesh.vertices[s.a]), at(key, resolution, mesh.vertices[s.b])});
    }
  }
  return edges;
}

/// Takes away the edges that lie on the border of a bounded map.
inline void drop_border(std::multiset<DirectedEdge>& edges, const voxel::Grid& grid) {
  if (!grid.bounds) return;
  constexpr std::int64_t kStep = voxel::kEdgeSteps;
  const auto line = [&](std::int32_t chunk, int back) {
    return (std::int64_t{chunk} * grid.resolution - back) * kStep + kStep / 2;
  };
  const std::int64_t x0 = line(grid.bounds->x0, 0), x1 = line(grid.bounds->x1, 1);
  const std::int64_t y0 = line(grid.bounds->y0, 0), y1 = line(grid.bounds->y1, 1);
  std::erase_if(edges, [&](const DirectedEdge& edge) {
    const auto& [p, q] = edge;
    return (p.first == q.first && (p.first == x0 || p.first == x1)) ||
           (p.second == q.second && (p.second == y0 || p.second == y1));
  });
}

/// What is wrong with one chunk's mesh by itself; empty when nothing is.
inline std::string flaw(const ChunkMesh& mesh) {
  std::vector<bool> used(mesh.vertices.size());
  for (std::size_t k = 0; k < mesh.triangles.size(); k += 3) {
    Point p[3];
    for (std::size_t e = 0; e < 3; ++e) {
      if (mesh.triangles[k + e] >= mesh.vertices.size()) return "an index beyond the vertices";
      used[mesh.triangles[k + e]] = true;
      p[e] = mesh.vertices[mesh.triangles[k + e]];
    }
    const std::int64_t twice = std::int64_t{p[1].x - p[0].x} * (p[2].y - p[0].y) -
                               std::int64_t{p[1].y - p[0].y} * (p[2].x - p[0].x);
    if (twice <= 0) return "a triangle without area or turned over";
  }
  for (const bool u : used) {
    if (!u) return "a vertex that no triangle uses";
  }
  for (const Section& s : mesh.sections) {
    const Point a = mesh.vertices[s.a], b = mesh.vertices[s.b];
    if (a == b) return "a wall without length";
    for (const voxel::Normal n : {s.normal_a, s.normal_b}) {
      const std::int64_t out = std::int64_t{n.x} * (b.y - a.y) - std::int64_t{n.y} * (b.x - a.x);
      if (out <= 0) return "a normal against its wall";
    }
  }
  return "";
}

}  // namespace earthwork::mesh
