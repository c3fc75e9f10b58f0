#!/usr/bin/env bash
# Measures earthwork-bench against the tutorial's own algorithm, in turn on one quiet machine.
#
#   tests/bench/compare.sh [FOLDER [ROUNDS [SIDE]]]
#
# FOLDER holds fields.cpp and naive2d.cpp, the yardstick (default ../shared/bench beside the
# project); ROUNDS is 5, SIDE of the fields 4096. Prints the ratio of each round, A B A B, and the
# median of the rounds. All rates are per second of processor time, one thread.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
yardstick=$(cd "${1:-$root/../shared/bench}" && pwd) || exit 2
rounds=${2:-5}
side=${3:-4096}
cd "$root"
for file in fields.cpp naive2d.cpp; do
  [ -f "$yardstick/$file" ] || { echo "no $file in $yardstick" >&2 && exit 2; }
done

scratch=$root/build/compare
mkdir -p "$scratch"
echo "== building"
clang++-19 -std=c++20 -O2 "$yardstick/fields.cpp" -o "$scratch/fields" -lz
clang++-19 -std=c++20 -O2 "$yardstick/naive2d.cpp" -o "$scratch/naive2d" -pthread
tests/build.sh release earthwork-bench
bench=build/release/bin/earthwork-bench

# value KEY: of the one JSON line on standard input.
value() {
  sed -n "s/.*\"$1\":\([-+.0-9e]*\).*/\1/p"
}

# ratio OURS THEIRS NAME UNIT: prints the round and adds it to the figure's list.
ratio() {
  awk -v a="$1" -v b="$2" -v name="$3" -v unit="$4" \
    'BEGIN { printf "%-24s %8.2fx   %12.0f against %12.0f %s/s\n", name, a / b, a, b, unit }'
  awk -v a="$1" -v b="$2" 'BEGIN { print a / b }' >>"$scratch/$3.ratios"
}

median() {
  sort -g "$1" | awk '{ v[NR] = $1 } END { printf "%.2fx", (v[int((NR + 1) / 2)] + v[int(NR / 2) + 1]) / 2 }'
}

rm -f "$scratch"/*.ratios
for kind in rings sparse noise; do
  field=$scratch/${kind}_$side.f32
  [ -f "$field" ] || "$scratch/fields" "$kind" "$side" "$field"
  for _ in $(seq "$rounds"); do
    theirs=$("$scratch/naive2d" "$field" 1 3 mesh | value per_cpu_s)
    ours=$("$bench" 2d "$field" 1 7 | value per_cpu_s)
    ratio "$ours" "$theirs" "$kind-mesh" cells
  done
  for _ in $(seq "$rounds"); do
    "$scratch/naive2d" "$field" 1 1 edit >"$scratch/theirs"
    "$bench" edit "$field" 1 1 >"$scratch/ours"
    for radius in 1 5 20; do
      theirs=$(grep "r=$radius\"" "$scratch/theirs" | value per_cpu_s)
      ours=$(grep "r=$radius, applied and meshed" "$scratch/ours" | value per_cpu_s)
      ratio "$ours" "$theirs" "$kind-edit-r$radius" edits
    done
  done
done

echo "== medians of $rounds rounds"
for file in "$scratch"/*.ratios; do
  printf '%-24s %s\n' "$(basename "$file" .ratios)" "$(median "$file")"
done
