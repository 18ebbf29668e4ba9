#!/bin/sh
# bench.sh MOTE PROFILE OUT: the experiments of one profile, into one run directory. A run that was
# stopped goes on where it stopped. Ends with the table and the figures.
set -eu
mote=$1
profile=$2
out=$3

# The same in every profile: the paper's method, and each baseline at its best known setting.
baselines='--method fcl-aabb:seed=none|previous,queue=2|64 --method fcl-obb --method fcl-obbrss'
failed=0

# measure ARGUMENT...: one mote run; a cell that failed (5) is a row of the table, not the end.
measure() {
    status=0
    "$mote" run "$@" --out "$out" || status=$?
    case $status in
    0) ;;
    5) failed=5 ;;
    *) exit "$status" ;;
    esac
}

case $profile in
quick)
    measure ww tt --replicates 3 $baselines \
        --method particle-paper --particles 1,3,5,16
    ;;
paper)
    measure ww tt mv --replicates 5 $baselines \
        --method 'particle-paper:refine=no|yes' --particles 1,2,3,5,8,16,32,64
    measure ww --replicates 5 --cache evict --method 'particle-paper:refine=no|yes' --particles 5,8 \
        --method 'fcl-aabb:seed=none|previous,queue=2|64' --stride 4
    ;;
full)
    measure ww tt mv --replicates 10 $baselines \
        --method 'particle-paper:refine=no|yes,start=random|fps' --particles 1-8,12,16,24,32,48,64
    measure ww tt mv --replicates 10 --cache evict --method 'particle-paper:refine=no|yes' \
        --particles 5,8,16 --method 'fcl-aabb:seed=none|previous,queue=2|64' --stride 4
    ;;
*)
    echo "bench.sh: unknown profile '$profile'; choose quick, paper or full" >&2
    exit 2
    ;;
esac

"$mote" summarize "$out"
"$mote" figures "$out"
exit $failed
