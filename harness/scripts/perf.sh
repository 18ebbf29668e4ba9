#!/bin/sh
# perf.sh check MOTE OUT: measures a fixed set into OUT and compares it with results/reference. Fails
# only if something is worse in two measurements, and names what remains undecided. perf.sh counts MOTE
# OUT: the same without times, which perf_ab.sh compares: judges only counts, bytes, accuracy and
# instructions. perf.sh accept MOTE OUT WHY: measures the set and makes it the reference, with a line in
# the history.
set -eu
action=$1
mote=$2
out=$3
reference=results/reference
replicates=30
floor=0.05
if [ "$action" = counts ]; then
    replicates=3
    floor=10 # a time would have to be eleven times as long
fi

ours="--method particle-paper:start=fps --method aabb-tree --method particle --method certified"
measure() {
    rm -rf "$out"
    # One seed: replicates differ only through the machine.
    for set in 'ww --frames 950-1149' 'mv --frames 300-499'; do
        # shellcheck disable=SC2086
        "$mote" run $set --replicates "$replicates" --seed 1 --fixed-seed --stride 1 --particles 5,16 \
            --method fcl-aabb $ours --out "$out" >/dev/null
    done
    if command -v valgrind >/dev/null; then
        # shellcheck disable=SC2086
        "$mote" instructions ww --frames 950-969 --particles 5,16 --method fcl-aabb $ours --out "$out"
    else
        echo "perf.sh: instructions are not counted: valgrind is not installed" >&2
    fi
}

# The exit status of the comparison.
compare() {
    status=0
    "$mote" compare "$reference" "$out" --floor "$floor" || status=$?
}

measure
case $action in
check | counts)
    compare
    if [ "$status" = 1 ]; then
        echo "perf-$action: something is worse: measured once more, to be sure" >&2
        measure
        compare
    fi
    case $status in
    0) ;;
    3) echo "perf-$action: warning: undecided, see above" >&2 ;;
    *) exit "$status" ;;
    esac
    ;;
accept)
    mkdir -p "$reference"
    rm -f "$reference/instructions.json"
    cp "$out/summary.json" "$out/manifest.json" "$reference/"
    if [ -f "$out/instructions.json" ]; then
        cp "$out/instructions.json" "$reference/"
    fi
    "$mote" history --add "$out" --why "$4"
    ;;
esac
