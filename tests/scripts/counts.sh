#!/bin/bash
# counts.sh COUNTS: does harness/scripts/counts.py (COUNTS) count and average what cells hold? Two cells of its
# own: one of 4 frames, one of 600, whose ranks are known.
set -euo pipefail
counts=$(realpath "$1")
. "$(dirname "$0")/work.sh"
refused() { # STATUS TEXT ARGUMENT...
    local wanted=$1 says=$2 status=0
    shift 2
    "$counts" "$@" >"$work/out" 2>&1 || status=$?
    [ "$status" = "$wanted" ] || fail "$*: status $status, not $wanted"
    grep -qF -- "$says" "$work/out" || fail "$*: does not say: $says"
}
refused 2 "usage: counts.py RUN"
refused 4 "cells has no frames" "$work"
mkdir "$work/cells"
cells() { # NAME FRAMES: frame k has k leaf pairs, 2 k positions; every second one is in contact, every tenth untested
    awk -v n="$2" 'BEGIN {
        print "frame,distance,positions,blocks,rows,leaf_pairs,triangle_tests,refined,contact,box_tests"
        for (k = n; k >= 1; --k)
            printf "%d,0.5,%d,3,%d,%d,0,0,%d,%d\n", k, 2 * k, k % 7, k, k % 2 == 0, k % 10
    }' >"$work/cells/$1-certified-r1-0123abcd.csv"
}
cells short 4
cells long-one 600
"$counts" "$work"
row() { # SCENARIO GROUP FRAMES FIRST LAST CONTACTS UNTESTED DISTANCE POSITIONS BLOCKS ROWS LEAF_PAIRS TRIANGLE_TESTS REFINED
    local IFS=,
    grep -qx "$*" "$work/counts.csv" || fail "no row $*:
$(cat "$work/counts.csv")"
}
row scenario group frames first last contacts untested distance positions blocks rows leaf_pairs triangle_tests refined
row short all 4 1 4 2 0 0.5 5 3 2.5 2.5 0 0
row long-one all 600 1 600 300 60 0.5 601 3 3 300.5 0 0
row long-one '40 to 60 %' 120 241 360 60 12 0.5 601 3 3 300.5 0 0
row long-one '90 to 95 %' 30 541 570 15 3 0.5 1111 3 2.96667 555.5 0 0
row long-one '99 to 100 %' 6 595 600 3 1 0.5 1195 3 2.5 597.5 0 0
[ "$(wc -l <"$work/counts.csv")" = 7 ] || fail "$(cat "$work/counts.csv")"
touch "$work/cells/tt-fcl-aabb-r1-0123abcd.csv"
refused 4 "a run of one replicate of certified alone has no such cell" "$work"
echo "counts.sh: all rows are right"
