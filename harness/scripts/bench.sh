#!/bin/sh
# bench.sh MOTE PROFILE OUT: runs the experiments of one profile in one run directory. A stopped run is
# continued. Ends with the figures, the report and one screen per scenario.
set -eu
mote=$1
profile=$2
out=$3
. "$(dirname "$0")/measure.sh"
. "$(dirname "$0")/engines.sh"

# FCL as its users call it, and at the best setting that we know of for coherent scenes.
plain=fcl-aabb:seed=none,queue=2
tuned=fcl-aabb:seed=previous,queue=64

# sizes: the same 200 frames, around a contact, of letters W of 1,000 to 1,000,000 triangles. Methods
# that take over 10 ms per frame are measured on every 16th frame; oriented boxes are left out at the
# largest sizes, where refits take too long.
sizes() {
    for part in ww-1k:1200-1399 ww-10k:1200-1399 ww:1200-1399 ww-100k:101-300 ww-1m:1-200; do
        scenario=${part%:*}
        oriented="--method fcl-obbrss"
        [ "$scenario" != ww-1m ] || oriented=
        # shellcheck disable=SC2086 # two words or none
        measure "$scenario" --frames "${part#*:}" --replicates 3 --timeout 3600 \
            --method $plain --method $tuned $oriented --method aabb-tree \
            --method particle:n=8 --method certified --method particle-paper:n=8
    done
}

# engines REPLICATES all|few: other engines and ours, asked for contacts and for distances. All that are asked
# the same question take turns, in every frame; few: in 200 frames of bodies that deform.
engines() {
    own='--method aabb-tree --method aabb-tree:build=samples --method certified'
    for part in ww:1201-1400 mv:301-500 tt:1-600; do
        scenario=${part%:*}
        frames=
        [ "$2" = all ] || frames="--frames ${part#*:}"
        case $scenario in
        tt) contact=tt distance=tt-distance ;;
        *) contact=$scenario-contact distance=$scenario ;;
        esac
        rigid=false
        [ $scenario != tt ] || rigid=true
        # shellcheck disable=SC2046,SC2086 # options and their values
        measure $contact --replicates "$1" --stride 1 $frames $own $(contact_engines) \
            $(if $rigid; then rigid_engines contact; fi)
        # shellcheck disable=SC2046,SC2086
        measure $distance --replicates "$1" --stride 1 $frames --method $plain $own $(distance_engines) \
            $(if $rigid; then rigid_engines distance; fi)
    done
    # The other rigid bodies, of which only contact is asked.
    for scenario in rigid-ww rigid-mv; do
        # shellcheck disable=SC2046,SC2086
        measure "$(ask_contact $scenario)" --replicates "$1" --stride 1 $own $(rigid_engines contact)
    done
}

# Measures the claims into the same directory, once per build; `make claims` reports whether this
# implementation meets its requirements (1).
claims() {
    [ -f "$out/claims.json" ] && [ "$out/claims.json" -nt "$mote" ] && return
    status=0
    "$mote" claims --out "$out" >"$out/claims.txt" || status=$?
    [ $status -le 1 ] || exit $status
}

# measure_best SCENARIO ARGUMENT...: also measures the best configurations of the engines of others and
# of FCL alone that `make tune` found on this scenario, if it ran and measured it. One that this build lacks
# is left out.
measure_best() {
    [ -f results/tune/tune.json ] || return 0
    for which in best best-fcl; do
        best=$("$mote" tune results/tune --$which "$1") || continue # which has said why
        [ -n "$best" ] || continue
        echo "bench.sh: $which on $1 is $best, says results/tune/tune.json" >&2
        measure_engine "${best%%:*}" "${best#"${best%%:*}"}" "$@"
    done
}

case $profile in
quick)
    measure ww tt --replicates 3 --method $plain --method $tuned --method fcl-obbrss \
        --method aabb-tree --method particle:n=8 --method certified \
        --method 'particle-paper:refine=no|near' --particles 1,3,5,16
    # Nothing deforms there: no refit is needed.
    measure tt --replicates 3 --method fcl-obb:update=none --method fcl-obbrss:update=none
    for scenario in ww tt; do measure_best $scenario --replicates 3; done
    ;;
paper)
    measure ww tt mv --replicates 5 --method 'fcl-aabb:seed=none|previous,queue=2|64' \
        --method 'fcl-obb:update=refit-top-down|refit-bottom-up' --method fcl-obbrss \
        --method aabb-tree --method hybrid-fcl:n=8 --method ccd-convex --method certified --method particle \
        --method 'particle-paper:refine=no|near|always' --particles 1,2,3,5,8,16,32,64
    measure ww mv --replicates 5 --method particle-paper:positions=given --particles 5,8
    measure ww mv --replicates 5 --method particle:n=8,positions=given \
        --method aabb-tree:positions=given
    measure tt --replicates 5 --method fcl-obb:update=none --method fcl-obbrss:update=none
    for scenario in ww tt mv ww-contact mv-contact tt-distance; do
        measure_best $scenario --replicates 5
    done
    engines 5 all
    measure ww --replicates 5 --cache evict --method $plain --method $tuned \
        --method aabb-tree --method particle:n=8 --method certified \
        --method particle-paper --particles 5,8
    ;;
full)
    measure ww tt mv --replicates 10 --method 'fcl-aabb:seed=none|previous,queue=2|64' \
        --method 'fcl-obb:update=refit-top-down|refit-bottom-up' --method fcl-obbrss \
        --method aabb-tree --method certified --method particle --method 'particle-paper:refine=no|near|always,start=random|fps' \
        --particles 1-8,12,16,24,32,48,64
    measure tt --replicates 10 --method fcl-obb:update=none --method fcl-obbrss:update=none
    for scenario in ww tt mv ww-contact mv-contact tt-distance; do
        measure_best $scenario --replicates 10
    done
    engines 10 all
    measure ww tt mv --replicates 10 --cache evict --method $plain --method $tuned \
        --method aabb-tree --method particle:n=8 --method certified \
        --method 'particle-paper:refine=no|near' --particles 5,8,16
    # Every built-in scenario of two bodies once, ten million triangles included.
    measure $("$mote" list scenarios | grep -v ' Several bodies: ' | cut -d ' ' -f 1) --replicates 1 --timeout 3600 \
        --method $plain --method $tuned --method aabb-tree --method particle:n=8 \
        --method certified --method particle-paper:n=8
    sizes
    measure ww-10m --replicates 3 --timeout 3600 --method $plain --method aabb-tree \
        --method particle:n=8 --method certified --method particle-paper:n=8
    ;;
sweep)
    sizes
    ;;
engines)
    engines 3 all
    ;;
engines-quick)
    engines 3 few
    ;;
*)
    echo "bench.sh: unknown profile '$profile'; choose quick, paper, full, sweep, engines or engines-quick" >&2
    exit 2
    ;;
esac

case $profile in
paper | full) claims ;;
esac

echo 'drawing the figures, writing the report' >&2
status=0
others=$("$mote" figures "$out" 2>&1 >/dev/null) || status=$?
[ $status -eq 0 ] || {
    printf '%s\n' "$others" >&2
    exit $status
}
"$mote" report "$out" >/dev/null
case $profile in
engines*) "$mote" summarize "$out" --engines ;;
*) "$mote" summarize "$out" --best ;;
esac
cat <<PLACES

report   $out/report.html, and report.md for a terminal
figures  $out/figures
CSV      $out/summary.csv, a line a configuration; fronts.csv and speed.csv beside it
PLACES
[ -z "$others" ] || printf '%s\n' "$others" >&2
exit $failed
