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

"$mote" summarize "$out" --format csv >/dev/null # writes summary.csv, too
"$(dirname "$0")/character_speed.py" "$out" || { failed=$?; [ $failed = 5 ] || exit $failed; }
cat "$out/characters.md"
exit "$failed"
