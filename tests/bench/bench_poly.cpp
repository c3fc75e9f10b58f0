#include <cstdio>
#include <stdexcept>

#include "server/mesh/triangulate.hpp"
#include "tests/bench/figures.hpp"
#include "tests/bench/outlines.hpp"
#include "tests/bench/timing.hpp"

namespace earthwork::bench {

void bench_triangulation(const Field& field, int reps) {
  const std::vector<Outline> outlines = make_outlines(make_map(field), size_of(field));
  double vertices = 0, triangles = 0;
  for (const Outline& outline : outlines) vertices += static_cast<double>(outline.vertices());
  if (vertices == 0) throw std::runtime_error(field.name + ": has no outline to triangulate");

  mesh::Triangulator triangulator;
  std::vector<std::uint16_t> indices;
  const auto run = [&] {
    triangles = 0;
    for (const Outline& outline : outlines) {
      indices.clear();
      triangulator.run(outline.points, outline.next, indices);
      triangles += static_cast<double>(indices.size() / 3);
    }
  };
  Report report{.tool = "earthwork, triangulation alone",
                .data = field.name,
                .threads = 1,
                .samples = time_each(reps, run),
                .work = vertices,
                .unit = "outline vertices",
                .figures = {{"vertices", vertices}, {"triangles", triangles}}};
  std::puts(to_line(report).c_str());
}

}  // namespace earthwork::bench
