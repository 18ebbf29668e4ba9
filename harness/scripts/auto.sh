#!/bin/sh
# auto.sh MOTE PROFILE OUT: method auto beside the two that it chooses from, certified, and stream with all vertices
# deformed at its own cost, on every built-in scenario of two bodies; the three take turns within one run. Prints a
# line a scenario with auto's time to that of the better one, by the median of all frames and by their sum from
# frame 50 on, of each frame the least of all replicates (least.awk), and writes the same to OUT/auto.txt. Fails where
# the ratio of medians is above 1.15, also after three times as many replicates: on a shared machine a few can all be
# disturbed. quick: up to 100,000 triangles a body; full: all but ww-10m. ONLY: a pattern of names. REPLICATES: of
# each (5).
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

# table: OUT/auto.txt from all cells.
table() {
    find "$out/cells" -name '*.csv' ! -name '*.pairs.csv' | sort |
        sed 's/\(.*\)[.]csv$/\1.json\n&/' | tr '\n' '\0' |
        xargs -0 awk -f "$(dirname "$0")/least.awk" >"$out/least.tsv"
    awk -F '\t' '
        !($1 in seen) { seen[$1] = 1; order[++count] = $1 }
        { median[$1, $2] = $5; sum[$1, $2] = $6 }
        function ratio(of, name, best) {
            best = of[name, "certified"] < of[name, "stream"] ? of[name, "certified"] : of[name, "stream"]
            # Times below that of reading the clock are no times.
            return best > 20 ? of[name, "auto"] / best : 1
        }
        END {
            printf "%-12s %10s %10s %10s %8s %8s\n", "us a frame", "certified", "stream", "auto", "median", "sum"
            for (i = 1; i <= count; ++i) {
                name = order[i]
                a = ratio(median, name)
                b = ratio(sum, name)
                verdict = a > 1.15 ? "  above 1.15" : ""
                bad += verdict != ""
                printf "%-12s %10.2f %10.2f %10.2f %8.3f %8.3f%s\n", name, median[name, "certified"] / 1000,
                    median[name, "stream"] / 1000, median[name, "auto"] / 1000, a, b, verdict
            }
            printf "%d scenarios, %d above 1.15\n", count, bad
        }' "$out/least.tsv" >"$out/auto.txt"
}

replicates=${REPLICATES:-5}
# shellcheck disable=SC2086 # names
measure_all "$replicates" $names
table
above=$(awk '/  above 1[.]15$/ { print $1 }' "$out/auto.txt")
if [ -n "$above" ]; then
    # shellcheck disable=SC2086 # names
    measure_all $((3 * replicates)) $above
    table
fi
cat "$out/auto.txt"
! grep -q '  above 1[.]15$' "$out/auto.txt" || exit 1
exit "$failed"
