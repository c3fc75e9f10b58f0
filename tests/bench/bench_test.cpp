// That the benchmarks measure the map they are given, and say so in the lines others read.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>

#include "server/mesh/triangulate.hpp"
#include "tests/bench/field.hpp"
#include "tests/bench/field_map.hpp"
#include "tests/bench/map_mesh.hpp"
#include "tests/bench/outlines.hpp"
#include "tests/bench/timing.hpp"

namespace earthwork::bench {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string scratch(const std::string& name) { return ::testing::TempDir() + "/" + name; }

void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

Field make_field(int nx, int ny, const std::function<double(double, double)>& value) {
  Field field{static_cast<std::uint32_t>(nx), static_cast<std::uint32_t>(ny), 1, {}, "made"};
  for (int y = 0; y < ny; ++y) {
    for (int x = 0; x < nx; ++x) field.values.push_back(static_cast<float>(value(x, y)));
  }
  return field;
}

void write_field(const Field& field, const std::string& path) {
  std::ofstream file(path, std::ios::binary);
  const std::array<std::uint32_t, 3> sides = {field.nx, field.ny, field.nz};
  file << "EWF1";
  file.write(reinterpret_cast<const char*>(sides.data()), sizeof sides);
  file.write(reinterpret_cast<const char*>(field.values.data()),
             static_cast<std::streamsize>(field.values.size() * sizeof(float)));
}

std::string refusal(const std::string& bytes) {
  const std::string path = scratch("bench_refused.f32");
  write_bytes(path, bytes);
  try {
    (void)read_field(path);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "accepted";
}

// The sample of the format's description.
const std::string kSample("EWF1\2\0\0\0\1\0\0\0\1\0\0\0\0\0\x80\xbf\0\0\x80\x3f", 24);

TEST(Field, ReadsTheDescribedSample) {
  const std::string path = scratch("bench_sample.f32");
  write_bytes(path, kSample);
  const Field field = read_field(path);
  EXPECT_EQ(field.nx, 2u);
  EXPECT_EQ(field.ny, 1u);
  EXPECT_EQ(field.nz, 1u);
  EXPECT_EQ(field.name, "bench_sample");
  EXPECT_EQ(field.values, (std::vector<float>{-1, 1}));
  EXPECT_EQ(field.at(-5, 3), -1);
  EXPECT_EQ(field.at(9, 0), 1);
}

TEST(Field, RefusesWhatIsNoField) {
  EXPECT_THAT(refusal(""), HasSubstr("not a field file"));
  EXPECT_THAT(refusal("EWF2" + kSample.substr(4)), HasSubstr("not a field file"));
  EXPECT_THAT(refusal(kSample.substr(0, 23)), HasSubstr("length does not follow"));
  EXPECT_THAT(refusal(kSample + "x"), HasSubstr("length does not follow"));
  EXPECT_THROW(read_field(scratch("bench_missing.f32")), std::runtime_error);
}

TEST(Field, BoundsItsSidesBeforeItTakesMemory) {
  const std::string head = "EWF1";
  const std::string one("\1\0\0\0", 4), none("\0\0\0\0", 4), most("\0\0\1\0", 4),
      over("\1\0\1\0", 4);
  EXPECT_THAT(refusal(head + none + one + one), HasSubstr("sides are"));
  EXPECT_THAT(refusal(head + over + one + one), HasSubstr("sides are"));
  EXPECT_THAT(refusal(head + most + one + one), HasSubstr("length"));
  EXPECT_THAT(refusal(head + most + most + one), HasSubstr("sides are"));
}

TEST(Field, RefusesValuesThatAreNotFinite) {
  std::string bytes = kSample;
  bytes.replace(20, 4, std::string("\0\0\xc0\x7f", 4));
  EXPECT_THAT(refusal(bytes), HasSubstr("not finite"));
}

TEST(FieldMap, PlacesCrossingsByInterpolation) {
  // Filled left of x = 10.25, in samples: a quarter of the way from voxel 10 to voxel 11.
  const voxel::Map map = make_map(make_field(128, 64, [](double x, double) { return x - 10.25; }));
  const voxel::Chunk* chunk = map.find({0, 0, 0, 0});
  ASSERT_NE(chunk, nullptr);
  EXPECT_EQ(map.find({0, 1, 0, 0}), nullptr);
  EXPECT_EQ(chunk->row(63), (1u << 11) - 1);
  EXPECT_EQ(chunk->mask(voxel::Axis::x, 5), 1u << 10);
  EXPECT_EQ(chunk->mask(voxel::Axis::y, 5), 0u);
  ASSERT_EQ(chunk->crossings(voxel::Axis::x, 5).size(), 1u);
  EXPECT_EQ(chunk->crossings(voxel::Axis::x, 5)[0], (voxel::Crossing{8192, {32767, 0}}));
}

TEST(FieldMap, PointsNormalsOutOfTheGround) {
  // Filled above y = 20.5.
  const voxel::Map map = make_map(make_field(64, 64, [](double, double y) { return 20.5 - y; }));
  const voxel::Chunk* chunk = map.find({0, 0, 0, 0});
  ASSERT_NE(chunk, nullptr);
  ASSERT_EQ(chunk->crossings(voxel::Axis::y, 20).size(), 64u);
  EXPECT_EQ(chunk->crossings(voxel::Axis::y, 20)[7], (voxel::Crossing{16384, {0, -32767}}));
}

TEST(FieldMap, HasNoCrossingOnTheMapsBorder) {
  const voxel::Map map =
      make_map(make_field(65, 64, [](double x, double) { return x > 63.5 ? 1 : -1; }));
  EXPECT_EQ(size_of(make_field(65, 64, [](double, double) { return 1; })).chunks_x, 1);
  EXPECT_TRUE(map.find({0, 0, 0, 0})->uniform());
}

TEST(MapMesh, HasADiscsArea) {
  const Field field = make_field(
      256, 256, [](double x, double y) { return std::hypot(x - 120.3, y - 131.7) - 80.5; });
  const voxel::Map map = make_map(field);
  MapMesh one(size_of(field)), two(size_of(field));
  one.mesh_all(map, 1);
  two.mesh_all(map, 2);
  EXPECT_EQ(one.figures(), two.figures());
  EXPECT_EQ(one.figures()[3].first, "area");
  EXPECT_NEAR(one.figures()[3].second, 3.14159265 * 80.5 * 80.5, 2.0);
}

TEST(MapMesh, FollowsEdits) {
  const Field field = make_field(128, 128, [](double x, double) { return x - 40; });
  voxel::Map map = make_map(field);
  MapMesh followed(size_of(field)), fresh(size_of(field));
  followed.mesh_all(map, 1);
  const voxel::Stencil stencil{64, 64, 20, voxel::Shape::circle, voxel::Fill::filled};
  followed.mesh_dirty(map, map.apply(0, {&stencil, 1}));
  fresh.mesh_all(map, 1);
  for (const std::size_t figure : {0u, 1u, 2u, 3u}) {
    EXPECT_EQ(followed.figures()[figure], fresh.figures()[figure]);
  }
}

TEST(Outlines, TriangulateToWhatTheMesherGives) {
  const Field field = make_field(
      128, 128, [](double x, double y) { return std::hypot(x - 60.3, y - 61.7) - 30.5; });
  const voxel::Map map = make_map(field);
  mesh::Triangulator triangulator;
  std::vector<std::uint16_t> indices;
  double triangles = 0, vertices = 0;
  for (const Outline& outline : make_outlines(map, size_of(field))) {
    indices.clear();
    triangulator.run(outline.points, outline.next, indices);
    triangles += static_cast<double>(indices.size() / 3);
    vertices += static_cast<double>(outline.vertices());
  }
  MapMesh meshes(size_of(field));
  meshes.mesh_all(map, 1);
  EXPECT_EQ(vertices, meshes.figures()[0].second);
  EXPECT_EQ(triangles, meshes.figures()[1].second);
  EXPECT_GT(triangles, 100);
}

TEST(Timing, TakesPercentilesByRank) {
  std::vector<double> values = {5, 1, 4, 2, 3};
  EXPECT_EQ(percentile(values, 0.5), 3);
  EXPECT_EQ(percentile(values, 0.99), 5);
  EXPECT_EQ(percentile(values, 0.01), 1);
}

TEST(Timing, WritesOneLineWithMedians) {
  const Report report{.tool = "t",
                      .data = "d",
                      .threads = 2,
                      .samples = {{3, 1, 1}, {1, 1, 3}, {2, 2, 2}},
                      .work = 12,
                      .unit = "cells",
                      .figures = {{"vertices", 7}}};
  EXPECT_THAT(to_line(report),
              StartsWith(R"({"tool":"t","data":"d","threads":2,"reps":3,"wall_s":2,"user_s":1,)"
                         R"("sys_s":2,"wall_min_s":1,"wall_max_s":3,"work":12,)"
                         R"("unit":"cells","per_wall_s":6,"per_cpu_s":4,)"
                         R"("vertices":7,"peak_rss_mb":)"));
}

TEST(Timing, CountsOneCallLessThanItMakes) {
  int calls = 0;
  EXPECT_EQ(time_each(3, [&] { ++calls; }).size(), 3u);
  EXPECT_EQ(calls, 4);
}

struct Outcome {
  int status;
  std::string output;
};

Outcome run(const std::string& arguments) {
  FILE* pipe = popen((EARTHWORK_BIN_DIR "/earthwork-bench " + arguments + " 2>&1").c_str(), "r");
  std::string output;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) output += static_cast<char>(c);
  return {WEXITSTATUS(pclose(pipe)), output};
}

TEST(Program, PrintsALineAFigure) {
  const std::string path = scratch("bench_disc.f32");
  write_field(
      make_field(128, 128, [](double x, double y) { return std::hypot(x - 64, y - 64) - 30; }),
      path);
  const Outcome mesh = run("2d " + path + " 2 3");
  EXPECT_EQ(mesh.status, 0);
  EXPECT_THAT(mesh.output, StartsWith(R"({"tool":"earthwork, full re-mesh","data":"bench_disc",)"
                                      R"("threads":2,"reps":3,)"));
  EXPECT_THAT(mesh.output, HasSubstr(R"("work":16129,"unit":"cells")"));
  const Outcome edits = run("edit " + path + " 1 1");
  EXPECT_EQ(edits.status, 0);
  EXPECT_EQ(std::count(edits.output.begin(), edits.output.end(), '\n'), 6);
  EXPECT_THAT(edits.output, HasSubstr("circle edit r=20, applied and meshed"));
  const Outcome poly = run("poly " + path + " 1 2");
  EXPECT_EQ(poly.status, 0);
  EXPECT_THAT(poly.output, HasSubstr(R"("unit":"outline vertices")"));
}

TEST(Program, SaysWhatIsWrongWithItsArguments) {
  const auto expect = [](const std::string& arguments, const std::string& line) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_THAT(outcome.output, HasSubstr(line)) << arguments;
  };
  expect("", "2d, edit or poly with FIELD THREADS REPS");
  expect("4d x 1 1", "2d, edit or poly with FIELD THREADS REPS");
  expect("3d x 1 1", "there are no 3D maps yet");
  expect("2d missing.f32 1 1", "missing.f32: cannot be opened");
  expect("2d missing.f32 0 1", "THREADS is a number from 1 to 64");
  expect("2d missing.f32 65 1", "THREADS is a number from 1 to 64");
  expect("2d missing.f32 1 1001", "REPS is a number from 1 to 1000");
  const std::string path = scratch("bench_small.f32");
  write_field(make_field(63, 64, [](double, double) { return 1; }), path);
  expect("2d " + path + " 1 1", "smaller than a 64 x 64 chunk");
  write_field(make_field(64, 64, [](double, double) { return 1; }), path);
  expect("poly " + path + " 1 1", "no outline to triangulate");
}

}  // namespace
}  // namespace earthwork::bench
