// earthwork-bench: figures to compare with other programs' on the same field files.
#include <charconv>
#include <cstdio>
#include <exception>
#include <string_view>

#include "tests/bench/field_map.hpp"
#include "tests/bench/figures.hpp"

namespace {

using namespace earthwork::bench;

constexpr const char* kUsage =
    "usage: earthwork-bench 2d|edit|poly FIELD THREADS REPS\n"
    "  2d    whole re-meshing\n"
    "  edit  circle edits of radius 1, 5, 20: applied, and applied and meshed; one thread always\n"
    "  poly  triangulation of the chunks' outlines alone; one thread always\n"
    "  FIELD is a field file (tests/bench/field.hpp), THREADS 1 .. 64, REPS 1 .. 1000.\n"
    "One JSON line a figure on stdout.\n";

int wrong(const char* why) {
  std::fprintf(stderr, "earthwork-bench: %s\n", why);
  return 2;
}

// 0 when `text` is no number from 1 to `most`.
int parse_count(std::string_view text, int most) {
  int value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc{} && stop == end && value >= 1 && value <= most ? value : 0;
}

int run(std::string_view what, const char* path, int threads, int reps) {
  const Field field = read_field(path);
  const MapSize size = size_of(field);
  if (field.nz != 1) return wrong("FIELD has more than one plane; 2D figures need one");
  if (size.chunks_x == 0 || size.chunks_y == 0)
    return wrong("FIELD is smaller than a 64 x 64 chunk");
  if (what == "2d") {
    bench_mesh(field, threads, reps);
  } else if (what == "edit") {
    bench_edits(field, reps);
  } else {
    bench_triangulation(field, reps);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view what = argc > 1 ? argv[1] : "";
  if (what == "--help") return std::fputs(kUsage, stdout), 0;
  if (what == "--version") return std::puts("earthwork-bench " EARTHWORK_VERSION), 0;
  if (what == "3d") return wrong("3d: there are no 3D maps yet");
  const bool known = what == "2d" || what == "edit" || what == "poly";
  if (argc != 5 || !known) return wrong("2d, edit or poly with FIELD THREADS REPS; see --help");
  const int threads = parse_count(argv[3], 64), reps = parse_count(argv[4], 1000);
  if (threads == 0) return wrong("THREADS is a number from 1 to 64");
  if (reps == 0) return wrong("REPS is a number from 1 to 1000");
  try {
    return run(what, argv[2], threads, reps);
  } catch (const std::exception& error) {
    return wrong(error.what());
  }
}
