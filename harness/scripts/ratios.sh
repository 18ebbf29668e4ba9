#!/bin/sh
# ratios.sh MOTE MOTE_AVX2 OUT: how much less time method stream takes than aabb-tree:positions=given and than the
# fastest configuration of FCL, where all that is known is positions: letters W of 11,920 triangles with their vertices
# in the mesh's order, as stream reads them (leaf), and in random order; the same with AVX2 only, where MOTE_AVX2, a
# program compiled so, is not empty; of 100,000 and 1,000,000 triangles; cloths and banners of 12,000 and 100,000; twist, fast-100
# and the three scenarios in which stream is least ahead. The methods take turns within a run; of each frame the least
# time of all replicates counts, and of these the median (least.awk). Prints a line a case, and writes the same to
# OUT/ratios.txt; ends with 5 where a case has no line. FCL is asked in a tenth of the frames. ONLY: a pattern of cases'
# names. REPLICATES: of each (5).
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

# compare CASE PROGRAM SCENARIO: a run of its own in OUT/CASE, and a line of the table.
compare() {
    case_name=$1
    out=$top/$1
    mote=$2
    replicates=${REPLICATES:-5}
    case $1 in 1m-*) [ "$replicates" -lt 3 ] || replicates=3 ;; esac
    measure "$3" --stride 1 --replicates "$replicates" --method stream --method aabb-tree:positions=given
    measure "$3" --stride 10 --replicates 2 --method 'fcl-aabb:seed=previous,queue=2|64'
    find "$out/cells" -name '*.csv' | sort | sed 's/\(.*\)[.]csv$/\1.json\n&/' | tr '\n' '\0' |
        xargs -0 awk -f "$(dirname "$0")/least.awk" | awk -F '\t' -v name="$case_name" '
        !($2 in best) || $5 < best[$2] { best[$2] = $5 }
        END {
            if (!("stream" in best) || !("aabb-tree" in best)) exit 1
            printf "%-16s %11.2f %11.2f %11.2f %9.2f %9.1f\n", name, best["stream"] / 1000,
                best["aabb-tree"] / 1000, best["fcl-aabb"] / 1000, best["aabb-tree"] / best["stream"],
                best["fcl-aabb"] / best["stream"]
        }' | tee -a "$top/ratios.txt"
    tail -n 1 "$top/ratios.txt" | grep -q -e "^$case_name " || failed=5
}

printf '%-16s %11s %11s %11s %9s %9s\n' 'us a frame' stream aabb-tree fcl-aabb 'to tree' 'to FCL' |
    tee "$top/ratios.txt"
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
[ "$(wc -l <"$top/ratios.txt")" -gt 1 ] || {
    echo "ratios.sh: ONLY=${ONLY-}: no case has such a name" >&2
    exit 2
}
exit $failed
