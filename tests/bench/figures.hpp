/// The figures that earthwork-bench measures; each prints one line of JSON to stdout.
#pragma once

#include "tests/bench/field.hpp"

namespace earthwork::bench {

/// Meshes the whole map again, `reps` times on `threads` threads.
void bench_mesh(const Field& field, int threads, int reps);

/// Circle edits of radius 1, 5 and 20 at places drawn by lot, `reps` times from the field as it
/// was: applied only, and applied and meshed. Two lines a radius.
void bench_edits(const Field& field, int reps);

/// Triangulates the outlines of all chunks, `reps` times; what leads to them is done before.
/// Throws std::runtime_error when there is no outline.
void bench_triangulation(const Field& field, int reps);

}  // namespace earthwork::bench
