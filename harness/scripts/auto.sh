#!/bin/sh
# auto.sh MOTE PROFILE OUT: method auto beside the two that it chooses from, certified, and stream with all vertices
# deformed at its own cost, on every built-in scenario of two bodies; the three take turns within one run. Prints a
# line a scenario with auto's time to that of the better one, by the median of all frames and by their sum from
# frame 50 on, of each frame the least of all replicates (least_ns of the summary), and writes the same to OUT/auto.txt
# (auto.py). Fails where the ratio of medians is above 1.15, also after three times as many replicates: on a shared
# machine a few can all be disturbed. quick: up to 100,000 triangles a body; full: all but ww-10m. ONLY: a pattern of
# names. REPLICATES: of each (5).
set -eu
mote=$1
profile=$2
out=$3
. "$(dirname "$0")/measure.sh"

case $profile in
full) too_large='^ww-10m$' ;;
*) too_large='-240k$\|-330k$\|-1m$\|^ww-10m$' ;;
esac
names=$("$mote" list scenarios | grep -v ' Several bodies: \| several: ' | cut -d ' ' -f 1 | grep -v -e "$too_large" |
    grep -e "${ONLY:-.}") || {
    echo "auto.sh: ONLY=${ONLY-}: no scenario has such a name" >&2
    exit 2
}

# measure_all REPLICATES NAME...: the three methods on these scenarios.
measure_all() {
    each=$1
    shift
    for name in "$@"; do
        measure "$name" --replicates "$each" --stride 1 --method certified --method stream:positions=deform --method auto
    done
}

# table: OUT/auto.txt from all cells, and in $verdict the status of auto.py.
table() {
    "$mote" summarize "$out" --format csv >/dev/null # writes summary.csv, too
    verdict=0
    "$(dirname "$0")/auto.py" "$out" || verdict=$?
}

replicates=${REPLICATES:-5}
# shellcheck disable=SC2086 # names
measure_all "$replicates" $names
table
case $verdict in
1 | 5) # failed: also where a run with more replicates was stopped
    # shellcheck disable=SC2046 # names
    measure_all $((3 * replicates)) $(sed -n 's/ .*  \(above 1[.]15\|failed\)$//p' "$out/auto.txt")
    table
    ;;
esac
[ $verdict = 4 ] || cat "$out/auto.txt"
[ $verdict = 0 ] || exit $verdict
exit "$failed"
