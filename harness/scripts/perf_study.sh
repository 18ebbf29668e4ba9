#!/bin/sh
# perf_study.sh BUILD OUT RACES PLANTED ONLY: measures how often the verdicts of races are wrong (make perf-study).
# Races already in OUT/races.csv are not repeated. ONLY="idle:2 compiler:5": planted slowdowns of 2 % on the machine as
# it is and of 5 % beside a compiler, and nothing else; "": all.
set -eu
build=$1
out=$2
mkdir -p "$out"
harness/scripts/relink.sh "$build" 12 "$out/programs" tests/race_planted
"$build/tests/race_study" run "$out/programs" "$out" "$3" "$4" "$5"
"$build/tests/race_study" table "$out/races.csv" "$out/power" >"$out/power.md" # no pipe, which would hide a failure
cat "$out/power.md"
grep -q '^[0-9]' "$out/power.dat" || exit 0 # nothing planted yet
gnuplot -c plots/draw.gp plots power "$out/power" "How small a slowdown a race finds" "" svg
