#!/bin/sh
# ablation.sh MOTE PROFILE OUT: what each step of the certified query contributes: leaves out one at a
# time, and tries every start. Writes OUT/summary.json, the table in OUT/ablation.txt, which it prints,
# and OUT/report.html with intervals. A stopped run is continued. quick: 200 frames of three scenarios,
# once; full: all frames, three times, also a million triangles.
set -eu
mote=$1
profile=$2
out=$3
. "$(dirname "$0")/measure.sh"

case $profile in
quick) set -- ww mv comb --frames 1-200 --replicates 1 ;;
paper | full) set -- ww fast-25 jump comb ww-1m --replicates 3 ;;
*)
    echo "ablation.sh: unknown profile '$profile'; choose quick, paper or full" >&2
    exit 2
    ;;
esac

measure "$@" \
    --method 'certified:seed=witness|pair|none|tracked' \
    --method 'certified:width=4|2' \
    --method 'certified:fits=constant' \
    --method 'certified:plane=off' \
    --method 'certified:directions=off' \
    --method 'certified:restarts=0' \
    --method 'certified:seed=none,restarts=0' \
    --method 'certified:slack=0.000001|0.001'
"$mote" summarize "$out" --format table >"$out/ablation.txt" # no pipe, which would hide a failure
cat "$out/ablation.txt"
"$mote" report "$out"
exit $failed
