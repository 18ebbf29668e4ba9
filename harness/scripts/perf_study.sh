#!/bin/sh
# perf_study.sh BUILD OUT RACES PLANTED ONLY: measures how often the verdicts of races are wrong (make perf-study).
# Races already in OUT/races.csv are not repeated. ONLY="idle:2 compiler:5": planted slowdowns of 2 % on the machine as
# it is and of 5 % beside a compiler, and nothing else; "": all. The two sides have no order of linking in common, so
# that races of unchanged builds meet the effect of layout as well.
set -eu
build=$1
out=$2
mkdir -p "$out"
orders=24 # as perf_ab.sh
harness/scripts/relink.sh "$build" $orders "$out/programs/a" tests/race_planted
harness/scripts/relink.sh "$build" $orders "$out/programs/b" tests/race_planted $((orders + 1))
"$build/tests/race_study" run "$out/programs" "$out" "$3" "$4" "$5"
"$build/tests/race_study" table "$out/races.csv" "$out/power" >"$out/power.md" # no pipe, which would hide a failure
cat "$out/power.md"
grep -q '^[0-9]' "$out/power.dat" || exit 0 # nothing planted yet
gnuplot -c plots/draw.gp plots power "$out/power" "How small a slowdown a race finds" "" svg
