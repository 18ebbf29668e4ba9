#!/bin/sh
# ingredients.sh MOTE PROFILE OUT: what each ingredient of the tracked particles contributes: switches
# one off or on at a time, and measures the front of speed against error over n, launch and track.
# Writes OUT/summary.json, the table in OUT/ingredients.txt, figures 13 and 14 and the report, and
# prints the table. A stopped run is continued. quick: once, 20 frames at a million triangles; full:
# three times, more scenarios, all frames.
set -eu
mote=$1
profile=$2
out=$3
. "$(dirname "$0")/measure.sh"

case $profile in
quick)
    small="ww fast-25 fast-100 jump comb" large="ww-1m --frames 1-20" replicates=1
    evicted="ww --frames 1001-1200"
    ;;
paper | full)
    small="ww fast-25 fast-100 jump comb tt mv vv teapot spider" large=ww-1m replicates=3
    evicted=ww
    ;;
*)
    echo "ingredients.sh: unknown profile '$profile'; choose quick, paper or full" >&2
    exit 2
    ;;
esac

for scenarios in "$small" "$large"; do
    # shellcheck disable=SC2086 # words
    measure $scenarios --replicates $replicates \
        --method 'particle:n=8,positions=lazy|given' \
        --method 'particle:n=0' \
        --method 'particle:n=8,refine=1' \
        --method 'particle:n=8,track=0' \
        --method 'particle:n=8,leap=off' \
        --method 'particle:n=8,descend=off,forces=off|on' \
        --method 'particle:n=8,start=random' \
        --method 'particle:n=8,reseed=off,forces=off|on' \
        --method 'particle:n=8,forces=on' \
        --method 'particle:n=2|4|16|32' \
        --method 'particle:n=8,launch=1|4|8' \
        --method 'particle:n=8,track=4|16|64' \
        --method 'particle:n=32,launch=32,track=64,refine=64'
done
# The methods they are compared with; also with evicted caches.
tuned=fcl-aabb:seed=previous,queue=64
for scenarios in ww "$large"; do
    # shellcheck disable=SC2086
    measure $scenarios --replicates $replicates --method $tuned --method aabb-tree
done
for scenarios in "$evicted" "$large"; do
    # shellcheck disable=SC2086
    measure $scenarios --replicates $replicates --cache evict --method $tuned --method aabb-tree --method particle:n=8
done
"$mote" summarize "$out" --format table >"$out/ingredients.txt" # no pipe, which would hide a failure
cat "$out/ingredients.txt"
"$mote" figures "$out" >/dev/null
"$mote" report "$out"
exit $failed
