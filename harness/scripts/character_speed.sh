#!/bin/sh
# character_speed.sh MOTE PROFILE OUT: two characters near each other, certified beside aabb-tree and FCL,
# whose trees are built at rest and by sample poses. Prints a table, which OUT/characters.md keeps: of each
# scenario, the median and 95th percentile of certified, the times of the faster tree of either kind as
# multiples of it, and the bytes a vertex. A stopped run is continued. quick: the smallest size of both
# characters in both scenes, 120 frames once; full: all sizes and the hands, all frames, three times. SCENARIOS names
# others.
set -eu
mote=$1
profile=$2
out=$3
. "$(dirname "$0")/measure.sh"

case $profile in
quick) set -- bison-15k jumper-20k bison-near-15k jumper-near-20k -- --frames 1-120 --replicates 1 ;;
paper | full)
    set -- bison-near-15k jumper-near-20k jumper-near-330k bison-15k bison-60k bison-240k jumper-20k jumper-80k \
        jumper-330k hands hand-shapes -- --replicates 3
    ;;
*)
    echo "character_speed.sh: unknown profile '$profile'; choose quick, paper or full" >&2
    exit 2
    ;;
esac
scenarios=
while [ "$1" != -- ]; do
    scenarios="$scenarios $1"
    shift
done
shift

for scenario in ${SCENARIOS:-$scenarios}; do
    measure "$scenario" "$@" --method certified --method 'aabb-tree:build=rest|samples' \
        --method 'fcl-aabb:seed=previous,queue=2|64,build=rest|samples'
done

# A key of a row stands on a line of its own, those of its numbers one level deeper.
"$mote" summarize "$out" --format json >/dev/null # writes summary.json; no pipe, which would hide a failure
awk '
    function value(line) { sub(/^[^:]*: */, "", line); gsub(/[",]/, "", line); return line }
    function kind(label) { return label ~ /^fcl/ ? "fcl" : label ~ /^aabb/ ? "tree" : "own" }
    function ratio(what, k, times) {
        if (!((k, what) in time))
            return "failed"
        times = time[k, what] / time[k, "own"]
        return sprintf(times < 100 ? "%.1f" : "%.0f", times)
    }
    /^   "scenario":/ { scenario = value($0); if (!(scenario in seen)) order[++count] = scenario; seen[scenario] = 1 }
    /^   "label":/ { own = kind(value($0)) }
    /^   "[a-z_]*": \{/ { within = $1 }
    /^    "median":/ && within == "\"total_ns\":" { median = value($0) }
    /^    "p95":/ && within == "\"total_ns\":" { p95 = value($0) }
    /^    "max":/ && within == "\"error\":" && own == "own" { error[scenario] = value($0) }
    /^   "heap_bytes_per_vertex":/ && own == "own" { bytes[scenario] = value($0) }
    /^   "counters":/ && median > 0 {
        if (!((scenario, own) in time) || median < time[scenario, own]) {
            time[scenario, own] = median
            slow[scenario, own] = p95
        }
        median = 0
    }
    END {
        print "| scenario | certified, median | p95 | aabb-tree / certified | its p95 | best FCL / certified | its p95 | bytes a vertex | largest error over L |"
        print "| --- | --- | --- | --- | --- | --- | --- | --- | --- |"
        for (i = 1; i <= count; ++i) {
            k = order[i]
            printf "| %s | %.1f us | %.1f us | %s | %.0f us | %s | %.0f us | %.0f | %.1e |\n", k,
                time[k, "own"] / 1000, slow[k, "own"] / 1000, ratio("tree", k), slow[k, "tree"] / 1000,
                ratio("fcl", k), slow[k, "fcl"] / 1000, bytes[k], error[k]
        }
    }' "$out/summary.json" >"$out/characters.md"
cat "$out/characters.md"
exit "$failed"
