#!/bin/sh
# verdicts.sh MOTE PROFILE OUT: asks every exact method of ours and every engine in this build whether the
# bodies touch, in every frame of every built-in scenario, and compares with the truth. Prints how many contacts
# each missed and invented, and writes the same to OUT/verdicts.txt. Fails where one of ours is wrong. A
# stopped run is continued. quick: every twentieth frame, and at most 20,000 triangles a body; paper: at most
# 100,000; full: every scenario. large: those from 60,000 to a million triangles alone, every twentieth frame.
# Elsewhere methods without state that take over 10 ms are asked in every 16th frame. JOBS: cells at once (2).
set -eu
mote=$1
profile=$2
out=$3
. "$(dirname "$0")/measure.sh"
. "$(dirname "$0")/engines.sh"

ours='certified stream aabb-tree auto'
case $profile in
quick | large) stride=20 ;;
paper | full) stride=auto ;;
*)
    echo "verdicts.sh: unknown profile '$profile'; choose quick, paper, full or large" >&2
    exit 2
    ;;
esac

# verdicts SCENARIO METHOD...: of those that this build has.
verdicts() {
    scenario=$1
    shift
    chosen=
    for engine; do
        if has "${engine%%:*}"; then chosen="$chosen --method $engine"; fi
    done
    # shellcheck disable=SC2086 # options and their values
    measure "$scenario" --replicates 1 --jobs "${JOBS:-2}" --timeout 7200 --stride $stride $chosen
}

names=$("$mote" list scenarios | grep -v ' Several bodies: \| several: ' | cut -d ' ' -f 1 | grep -v -e '-contact$' -e '-distance$')
large='-100k$\|-60k$\|-80k$\|-240k$\|-330k$\|-1m$\|-10m$'
small_names=$(echo "$names" | grep -v -e "$large")
[ "$profile" != large ] || small_names=
large_names=$(echo "$names" | grep -e "$large" | sed 's/m$/M/' | sort -t - -k 2h | sed 's/M$/m/')
for name in $small_names $large_names; do
    case $profile:$name in
    quick:*-100k | quick:*-60k | quick:*-80k | large:*-10m) continue ;;
    full:* | large:*) ;;
    *-240k | *-330k | *-1m | *-10m) continue ;;
    esac
    asked=$(ask_contact "$name")
    # shellcheck disable=SC2086 # words
    verdicts "$asked" $ours fcl-aabb fcl-aabb:build=samples 'fcl-aabb:call=api' ode:vertices=double \
        ode:vertices=single bullet-gimpact bullet-gimpact:stop=yes embree-contact coal-aabb \
        coal-aabb:bound=full,contact=distance,seed=previous ccd-convex
    case $name in
    # Oriented volumes are refitted top-down: seconds a frame.
    ww-1m | ww-10m | *-330k | *-240k) continue ;;
    esac
    verdicts "$asked" fcl-kdop18 fcl-obb fcl-rss fcl-obbrss fcl-kios coal-obb coal-rss coal-obbrss coal-kios \
        fcl-obb:update=refit-bottom-up fcl-rss:update=refit-bottom-up fcl-obbrss:update=refit-bottom-up \
        fcl-kios:update=refit-bottom-up coal-obb:update=refit-bottom-up coal-obbrss:update=refit-bottom-up \
        coal-kios:update=refit-bottom-up
    case $name in
    flat | rigid-* | sliver-* | still | touch | tt)
        verdicts "$asked" fcl-obb:update=none fcl-rss:update=none fcl-obbrss:update=none fcl-kios:update=none \
            coal-obb:update=none coal-rss:update=none coal-obbrss:update=none coal-kios:update=none \
            ode:update=none,vertices=double ode:update=none,vertices=single bullet-gimpact:update=none
        ;;
    esac
done

"$mote" summarize "$out" --format csv >/dev/null # writes summary.csv, too
status=0
awk -v ours="$ours" -f "$(dirname "$0")/verdicts.awk" "$out/summary.csv" >"$out/verdicts.txt" || status=$?
cat "$out/verdicts.txt"
[ $status -eq 0 ] || exit $status
exit $failed
