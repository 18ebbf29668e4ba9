#!/bin/sh
# ingredients.sh MOTE PROFILE OUT: what each ingredient of the tracked particles contributes: one
# switched off or on at a time, and the front of speed against error over n, launch and track.
# Leaves OUT/summary.json, the table in OUT/ingredients.txt, and prints it. A run that was stopped
# goes on where it stopped. quick: 200 frames of four scenarios, once; full: all frames, three
# times, a million triangles too.
set -eu
mote=$1
profile=$2
out=$3

case $profile in
quick) set -- ww comb vv mv --frames 1-200 --replicates 1 ;;
paper | full) set -- ww fast-25 fast-100 jump comb vv mv ww-1m --replicates 3 ;;
*)
    echo "ingredients.sh: unknown profile '$profile'; choose quick, paper or full" >&2
    exit 2
    ;;
esac

# A cell that failed (5) is a row, not the end.
status=0
"$mote" run "$@" --out "$out" \
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
    --method 'particle:n=8,launch=0|1|4|8' \
    --method 'particle:n=8,track=4|16|64' \
    --method 'particle:n=32,launch=32,track=64,refine=64' >/dev/null || status=$?
[ "$status" = 0 ] || [ "$status" = 5 ] || exit "$status"
"$mote" summarize "$out" --format table | tee "$out/ingredients.txt"
exit "$status"
