#!/bin/sh
# bench.sh MOTE PROFILE OUT: the experiments of one profile, into one run directory. A run that was
# stopped goes on where it stopped. Ends with the table, the figures and the report.
set -eu
mote=$1
profile=$2
out=$3
failed=0

# measure ARGUMENT...: one mote run; a cell that failed (5) is a row of the table, not the end.
measure() {
    status=0
    "$mote" run "$@" --out "$out" >/dev/null || status=$?
    case $status in
    0) ;;
    5) failed=5 ;;
    *) exit "$status" ;;
    esac
}

# FCL as its users call it, and at the best setting that we know of for coherent scenes.
plain=fcl-aabb:seed=none,queue=2
tuned=fcl-aabb:seed=previous,queue=64

case $profile in
quick)
    measure ww tt --replicates 3 --method $plain --method $tuned --method fcl-obbrss \
        --method aabb-tree --method particle:n=8 --method certified \
        --method 'particle-paper:refine=no|near' --particles 1,3,5,16
    # Nothing deforms there: no refit is needed.
    measure tt --replicates 3 --method fcl-obb:update=none --method fcl-obbrss:update=none
    ;;
paper)
    measure ww tt mv --replicates 5 --method 'fcl-aabb:seed=none|previous,queue=2|64' \
        --method fcl-obb --method fcl-obbrss --method aabb-tree --method hybrid-fcl:n=8 \
        --method ccd-convex --method particle:n=8 --method certified \
        --method 'particle-paper:refine=no|near|always' --particles 1,2,3,5,8,16,32,64
    measure ww mv --replicates 5 --method particle-paper:positions=given --particles 5,8
    measure ww mv --replicates 5 --method particle:n=8,positions=given \
        --method aabb-tree:positions=given
    measure tt --replicates 5 --method fcl-obb:update=none --method fcl-obbrss:update=none
    measure ww --replicates 5 --cache evict --method $plain --method $tuned \
        --method aabb-tree --method particle:n=8 --method certified \
        --method particle-paper --particles 5,8
    ;;
full)
    measure ww tt mv --replicates 10 --method 'fcl-aabb:seed=none|previous,queue=2|64' \
        --method fcl-obb --method fcl-obbrss \
        --method 'particle-paper:refine=no|near|always,start=random|fps' \
        --particles 1-8,12,16,24,32,48,64
    measure tt --replicates 10 --method fcl-obb:update=none --method fcl-obbrss:update=none
    measure ww tt mv --replicates 10 --cache evict --method $plain --method $tuned \
        --method aabb-tree --method particle:n=8 --method certified \
        --method 'particle-paper:refine=no|near' --particles 5,8,16
    # Every built-in scenario once, ten million triangles included.
    measure $("$mote" list scenarios | cut -d ' ' -f 1) --replicates 1 --timeout 3600 \
        --method $plain --method $tuned --method aabb-tree --method particle:n=8 \
        --method certified --method particle-paper:n=8
    ;;
*)
    echo "bench.sh: unknown profile '$profile'; choose quick, paper or full" >&2
    exit 2
    ;;
esac

"$mote" summarize "$out"
"$mote" figures "$out"
"$mote" report "$out"
exit $failed
