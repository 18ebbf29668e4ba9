#!/bin/sh
# tune.sh MOTE PROFILE OUT: measures every useful configuration of every baseline on every scenario of
# the paper, for both questions, and on a scene of many bodies, in one run directory; ends with the best
# of each. A stopped run is continued. quick: 100 frames of each scenario, once; full: all frames, three
# times.
set -eu
mote=$1
profile=$2
out=$3
. "$(dirname "$0")/measure.sh"
. "$(dirname "$0")/engines.sh"

case $profile in
quick) replicates=1 ;;
paper | full) replicates=3 ;;
*)
    echo "tune.sh: unknown profile '$profile'; choose quick, paper or full" >&2
    exit 2
    ;;
esac

# frames SCENARIO: frames in which it is near and far in turn.
frames() {
    [ "$profile" = quick ] || return 0
    case $1 in
    ww*) echo --frames 1201-1300 ;;
    letters) echo --frames 1-10 ;;
    *) echo --frames 201-300 ;;
    esac
}

for scenario in ww tt mv; do
    # Words of frames are options. shellcheck disable=SC2046
    set -- "$scenario" --replicates $replicates $(frames $scenario)
    measure "$@" --method 'fcl-aabb:queue=2|64,seed=none|previous' \
        --method 'fcl-aabb:update=refit-top-down|rebuild' \
        --method 'fcl-aabb:call=api,seed=none|previous' \
        --method 'fcl-kdop18:update=refit-bottom-up|refit-top-down|rebuild' \
        --method 'hybrid-fcl:n=3|8|16,refine=no|always,queue=2|64' \
        --method 'aabb-tree:seed=none|previous,build=rest|samples' \
        --method 'ccd-convex:support=climb|scan' \
        --method 'particle-paper:refine=no|near|always,start=random|fps' --particles 3,5,8,16
    for volume in obb rss obbrss kios; do
        measure "$@" --method "fcl-$volume:update=refit-top-down|refit-bottom-up,queue=2|64" \
            --method "fcl-$volume:update=rebuild"
        if [ $volume != obb ]; then
            measure "$@" --method "fcl-$volume:call=api"
        fi
        # With seeds, answers depend on the previous frame, so no frame can be left out.
        if [ "$profile" != quick ] || [ $volume = obbrss ]; then
            measure "$@" --method "fcl-$volume:seed=previous,queue=2|64"
        fi
    done
    if [ $scenario = tt ]; then
        measure "$@" --method 'fcl-obb:update=none,call=node|api' \
            --method 'fcl-rss:update=none' --method 'fcl-obbrss:update=none,call=node|api' \
            --method 'fcl-kios:update=none,call=node|api'
    fi
done

# The engines on these frames, asked for contacts and for distances.
for scenario in ww mv tt-distance; do
    # shellcheck disable=SC2046
    measure $scenario --replicates $replicates $(frames $scenario) $(distance_engines)
done
for scenario in ww-contact mv-contact tt; do
    # shellcheck disable=SC2046
    set -- $scenario --replicates $replicates $(frames $scenario)
    measure "$@" --method certified --method 'aabb-tree:seed=none|previous,build=rest|samples'
    # shellcheck disable=SC2046
    measure "$@" $(contact_engines)
done
for scenario in tt tt-distance; do
    question=contact
    [ $scenario = tt ] || question=distance
    # shellcheck disable=SC2046
    measure $scenario --replicates $replicates $(frames $scenario) $(rigid_engines $question)
done

# Characters: trees are built at rest and by sample poses, and the better one counts.
for scenario in bison-15k jumper-20k; do
    # shellcheck disable=SC2046
    set -- $scenario --replicates $replicates $(frames $scenario)
    # shellcheck disable=SC2046
    measure "$@" $(distance_engines)
    measure "$@" --method certified --method 'aabb-tree:seed=none|previous,build=rest|samples' \
        --method 'fcl-aabb:build=rest|samples' --method 'fcl-rss:build=rest|samples' \
        --method 'posed-parts:search=fcl|certified'
done

# shellcheck disable=SC2046
measure letters --replicates $replicates $(frames letters) --method certified \
    --method 'fcl-aabb:refit=near|every' --method 'aabb-tree:refit=near|every' \
    --method 'particle:n=3|8|16' --method 'particle-paper:n=3|8|16,refine=no|near,start=random|fps'

"$mote" summarize "$out" --format csv >/dev/null # writes summary.json and summary.csv, too
"$mote" tune "$out"
exit $failed
