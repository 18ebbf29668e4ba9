#!/bin/sh
# ratios.sh MOTE MOTE_AVX2 OUT: how much less time method stream takes than aabb-tree:positions=given and than the
# fastest configuration of FCL, where all that is known is positions: letters W of 11,920 triangles with their vertices
# in the mesh's order, as stream reads them (leaf), and in random order; the same with AVX2 only, where MOTE_AVX2, a
# program compiled so, is not empty; of 100,000 and 1,000,000 triangles; cloths and banners of 12,000 and 100,000; twist, fast-100
# and the three scenarios in which stream is least ahead. All methods of a case are given all positions at no charge,
# take turns within one run, are asked in the same frames and run equally often: 5 times, or 3 where FCL takes 130 ms
# a frame. Of each frame the least time of all replicates counts, and of these the median (least_ns of the summary).
# Prints a line a case, and writes the same to OUT/ratios.txt (ratios.py); ends with 5 where a method failed. ONLY: a
# pattern of cases' names. REPLICATES: of each, at most.
set -eu
ours=$1
avx2=$2
top=$3
. "$(dirname "$0")/measure.sh"

data=$top/data
mkdir -p "$data"

# wanted CASE: whether ONLY asks for it.
wanted() {
    printf '%s\n' "$1" | grep -q -e "${ONLY:-.}"
}

# letters TRIANGLES ORDER FRAMES START: the path of a scenario like ww between letters with their vertices in an order.
letters() {
    mesh=$data/W-$1-$2.obj
    [ -e "$mesh" ] || "$ours" letter W --triangles "$1" --order "$2" -o "$mesh" >/dev/null
    body="{\"letter\": null, \"triangles\": null, \"file\": \"W-$1-$2.obj\"}"
    printf '{"purpose": "ww, vertices in %s order.", "like": "ww", "frames": %s, "start": %s, "warmup": null,
 "active": null, "bodies": [%s, %s]}\n' "$2" "$3" "$4" "$body" "$body" >"$data/ww-$1-$2.json"
    echo "$data/ww-$1-$2.json"
}

# sheet KIND TRIANGLES: the path of the scenario of a cloth or a banner.
sheet() {
    [ -e "$data/$2/$1.json" ] || "$ours" sequence "$1" --triangles "$2" --out "$data/$2" >/dev/null
    echo "$data/$2/$1.json"
}

# compare CASE PROGRAM SCENARIO: a run of its own in OUT/CASE, for a line of the table.
cases=
compare() {
    out=$top/$1
    mote=$2
    replicates=${REPLICATES:-5}
    case $1 in 1m-* | cloth-100000) [ "$replicates" -lt 3 ] || replicates=3 ;; esac
    measure "$3" --stride 1 --replicates "$replicates" --method stream --method aabb-tree:positions=given \
        --method 'fcl-aabb:seed=previous,queue=2|64,positions=given'
    "$mote" summarize "$out" --format csv >/dev/null # writes summary.csv, too
    cases="$cases $1"
}

for order in letter leaf random; do
    wanted 12k-$order || continue
    compare 12k-$order "$ours" "$(letters 11920 $order 1984 1)"
done
if [ -n "$avx2" ] && wanted 12k-avx2; then
    compare 12k-avx2 "$avx2" "$(letters 11920 letter 1984 1)"
fi
for order in letter leaf; do
    ! wanted 100k-$order || compare 100k-$order "$ours" "$(letters 100000 $order 200 1100)"
    ! wanted 1m-$order || compare 1m-$order "$ours" "$(letters 1000000 $order 40 1100)"
done
for kind in cloth banner; do
    for triangles in 11920 100000; do
        ! wanted $kind-$triangles || compare $kind-$triangles "$ours" "$(sheet $kind $triangles)"
    done
done
for name in twist fast-100 jump still fast-5; do
    ! wanted "$name" || compare "$name" "$ours" "$name"
done
[ -n "$cases" ] || {
    echo "ratios.sh: ONLY=${ONLY-}: no case has such a name" >&2
    exit 2
}
# shellcheck disable=SC2086 # names
"$(dirname "$0")/ratios.py" "$top" $cases || { failed=$?; [ $failed = 5 ] || exit $failed; }
cat "$top/ratios.txt"
exit "$failed"
