#!/bin/sh
# impact_speed.sh MOTE PROFILE OUT: the time of impact within steps of several frames, by certified, by conservative
# advancement with aabb-tree and by samples. Writes OUT/summary.json and prints the tables. FCL's continuous collision takes
# seconds a question, of bodies that do not deform: OUT/fcl has a run of a few questions of its own. A stopped run is
# continued. quick: few questions, once; full: from every fifth frame on, three times.
set -eu
mote=$1
profile=$2
out=$3
. "$(dirname "$0")/measure.sh"

case $profile in
quick)
    set -- mv rigid-mv --step 10,100 --stride 26 --replicates 1
    fcl="rigid-mv --frames 350-600 --step 1,3 --stride 50"
    ;;
paper | full)
    set -- mv ww rigid-mv rigid-ww --step 1,3,10,30,100 --stride 5 --replicates 3
    fcl="rigid-mv --frames 350-600 --step 1,3,10,30,100 --stride 25"
    ;;
*)
    echo "impact_speed.sh: unknown profile '$profile'; choose quick, paper or full" >&2
    exit 2
    ;;
esac

measure "$@" --method certified --method aabb-tree --method 'impact-sampled:samples=3|10|30'
"$mote" summarize "$out" --format table
out=$out/fcl
# shellcheck disable=SC2086 # words
measure $fcl --replicates 1 --method certified --method fcl-continuous
"$mote" summarize "$out" --format table
exit $failed
