// Triangles inside given outlines: as many as there must be, none without area, all the ground.
#include "server/mesh/triangulate.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>

namespace earthwork::mesh {
namespace {

using Loop = std::vector<Point>;

struct Input {
  std::vector<Point> points;
  std::vector<std::uint16_t> next;
};

/// Loops, filled ground on the left of each, as the triangulator wants them.
Input outline(const std::vector<Loop>& loops) {
  std::vector<Point> all;
  std::vector<std::size_t> follower;
  for (const Loop& loop : loops) {
    const std::size_t first = all.size();
    for (std::size_t k = 0; k < loop.size(); ++k) {
      all.push_back(loop[k]);
      follower.push_back(first + (k + 1) % loop.size());
    }
  }
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(all[a].y, all[a].x) < std::pair(all[b].y, all[b].x);
  });
  std::vector<std::uint16_t> rank(all.size());
  for (std::size_t k = 0; k < order.size(); ++k) rank[order[k]] = static_cast<std::uint16_t>(k);
  Input input{std::vector<Point>(all.size()), std::vector<std::uint16_t>(all.size())};
  for (std::size_t k = 0; k < all.size(); ++k) {
    input.points[rank[k]] = all[k];
    input.next[rank[k]] = rank[follower[k]];
  }
  return input;
}

std::int64_t twice_area(const Loop& loop) {
  std::int64_t sum = 0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Point p = loop[k], q = loop[(k + 1) % loop.size()];
    sum += std::int64_t{p.x} * q.y - std::int64_t{p.y} * q.x;
  }
  return sum;
}

void expect_cut(const std::vector<Loop>& loops, std::size_t triangles) {
  const Input input = outline(loops);
  ChunkMesh mesh;
  mesh.vertices = input.points;
  Triangulator().run(input.points, input.next, mesh.triangles);
  EXPECT_EQ(mesh.triangles.size(), 3 * triangles);
  std::int64_t expected = 0;
  for (const Loop& loop : loops) expected += twice_area(loop);
  EXPECT_EQ(static_cast<std::int64_t>(mesh::twice_area(mesh)), expected);
  for (std::size_t k = 0; k + 2 < mesh.triangles.size(); k += 3) {
    const Loop triangle{mesh.vertices[mesh.triangles[k]], mesh.vertices[mesh.triangles[k + 1]],
                        mesh.vertices[mesh.triangles[k + 2]]};
    EXPECT_GT(twice_area(triangle), 0);
  }
}

Loop box(int x0, int y0, int x1, int y1) { return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}; }
Loop reversed(Loop loop) {
  std::reverse(loop.begin(), loop.end());
  return loop;
}

TEST(Triangulate, ATriangleIsItself) { expect_cut({{{0, 0}, {4, 1}, {1, 5}}}, 1); }

TEST(Triangulate, ASquareIsTwo) { expect_cut({box(0, 0, 4, 4)}, 2); }

TEST(Triangulate, PointsInARowAlongASideAreKept) {
  expect_cut({{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 3}, {2, 3}, {1, 3}, {0, 3}, {0, 2}, {0, 1}}}, 8);
}

TEST(Triangulate, AHoleCostsTwoMore) {
  expect_cut({box(0, 0, 9, 9), reversed(box(3, 3, 6, 6))}, 8);
}

TEST(Triangulate, ThreeHolesInARow) {
  expect_cut({box(0, 0, 20, 6), reversed(box(2, 2, 4, 4)), reversed(box(8, 2, 10, 4)),
              reversed(box(14, 2, 16, 4))},
             16 + 6 - 2);
}

TEST(Triangulate, AnIslandInAHole) {
  expect_cut({box(0, 0, 12, 12), reversed(box(2, 2, 10, 10)), box(4, 4, 8, 8)}, 8 + 2);
}

TEST(Triangulate, CombsUpAndDown) {
  Loop comb;
  for (int k = 0; k < 20; ++k) {
    comb.push_back({4 * k, 0}), comb.push_back({4 * k + 1, 9}), comb.push_back({4 * k + 2, 9});
    comb.push_back({4 * k + 3, 0});
  }
  comb.push_back({80, -3}), comb.push_back({-1, -3});
  expect_cut({reversed(comb)}, comb.size() - 2);
  Loop hanging;
  for (Point p : comb) hanging.push_back({p.x, -p.y});
  expect_cut({hanging}, comb.size() - 2);
}

TEST(Triangulate, ASpiral) {
  Loop out, back;
  for (int k = 0; k < 24; ++k) {
    const int r = 4 * k + 4, side = k % 4;
    const Point corner{side == 0 || side == 3 ? -r : r, side < 2 ? -r : r};
    out.push_back(corner);
    back.push_back({corner.x + (corner.x < 0 ? 1 : -1), corner.y + (corner.y < 0 ? 1 : -1)});
  }
  out.insert(out.end(), back.rbegin(), back.rend());
  if (twice_area(out) < 0) std::reverse(out.begin(), out.end());
  expect_cut({out}, out.size() - 2);
}

/// Unit squares chosen at random, their outline traced. No two may touch at a corner only.
std::vector<Loop> random_pixels(int side, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<std::vector<bool>> on(static_cast<std::size_t>(side) + 2,
                                    std::vector<bool>(static_cast<std::size_t>(side) + 2));
  const auto cell = [&](int x, int y) -> std::vector<bool>::reference {
    return on[static_cast<std::size_t>(y) + 1][static_cast<std::size_t>(x) + 1];
  };
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) cell(x, y) = random() % 5 < 3;
  }
  for (bool changed = true; changed;) {
    changed = false;
    for (int y = 0; y + 1 < side; ++y) {
      for (int x = 0; x + 1 < side; ++x) {
        const bool a = cell(x, y), b = cell(x + 1, y), c = cell(x, y + 1), d = cell(x + 1, y + 1);
        if (a == d && b == c && a != b) cell(x, y) = cell(x + 1, y) = true, changed = true;
      }
    }
  }
  std::map<std::pair<int, int>, Point> follower;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      if (!cell(x, y)) continue;
      if (!cell(x, y - 1)) follower[{x, y}] = {x + 1, y};
      if (!cell(x + 1, y)) follower[{x + 1, y}] = {x + 1, y + 1};
      if (!cell(x, y + 1)) follower[{x + 1, y + 1}] = {x, y + 1};
      if (!cell(x - 1, y)) follower[{x, y + 1}] = {x, y};
    }
  }
  std::vector<Loop> loops;
  while (!follower.empty()) {
    Loop loop;
    for (auto at = follower.begin(); at != follower.end();) {
      loop.push_back({at->first.first, at->first.second});
      const Point to = at->second;
      follower.erase(at);
      at = follower.find({to.x, to.y});
    }
    loops.push_back(loop);
  }
  return loops;
}

// Every vertex lies on a line with many others: all that can go wrong with flat triangles does.
RC_GTEST_PROP(Triangulate, RandomPixelsWithHoles, ()) {
  const auto loops = random_pixels(*rc::gen::inRange(1, 24), *rc::gen::arbitrary<std::uint32_t>());
  std::size_t vertices = 0, outer = 0, holes = 0;
  for (const Loop& loop : loops) {
    vertices += loop.size();
    (twice_area(loop) > 0 ? outer : holes) += 1;
  }
  if (loops.empty()) return;
  expect_cut(loops, vertices + 2 * holes - 2 * outer);
  RC_ASSERT(!testing::Test::HasFailure());
}

}  // namespace
}  // namespace earthwork::mesh
