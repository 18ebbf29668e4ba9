#!/bin/sh
# perf.sh check MOTE OUT: measures a fixed set into OUT and compares it with results/reference. Fails
#   only where something is worse, and says where nothing can be said.
# perf.sh accept MOTE OUT WHY: measures it and makes it the reference, with a line in the history.
set -eu
action=$1
mote=$2
out=$3
reference=results/reference

# No random starts: replicates differ by the machine only, and counts are the same every time.
ours="--method particle-paper:start=fps --method aabb-tree"
for name in particle certified; do
    if "$mote" list methods | grep -q "^$name:"; then
        ours="$ours --method $name"
    fi
done
rm -rf "$out"
for set in 'ww --frames 950-1149' 'mv --frames 300-499'; do
    # shellcheck disable=SC2086
    "$mote" run $set --replicates 10 --seed 1 --stride 1 --particles 5,16 --method fcl-aabb $ours \
        --out "$out" >/dev/null
done

case $action in
check)
    status=0
    "$mote" compare "$reference" "$out" --floor 0.05 || status=$?
    case $status in
    0) ;;
    3) echo "perf-check: warning: undecided, see above" >&2 ;;
    *) exit "$status" ;;
    esac
    ;;
accept)
    mkdir -p "$reference"
    cp "$out/summary.json" "$out/manifest.json" "$reference/"
    "$mote" history --add "$out" --why "$4"
    ;;
esac
