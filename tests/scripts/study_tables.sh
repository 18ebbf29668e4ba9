#!/bin/bash
# study_tables.sh SCRIPTS: are the tables that character_speed.sh, auto.sh and ratios.sh (in SCRIPTS) print those of a
# run's summary? The program here notes what it is asked to in calls, and its summaries are planted.
set -euo pipefail
scripts=$(realpath "$1")
. "$(dirname "$0")/work.sh"
shown="said err"
cd "$work"
unset ONLY REPLICATES SCENARIOS
# Of the files plan-1, plan-2, ... each summary takes one, and the last one again.
cat >mote <<'MOTE'
#!/bin/sh
cd "$(dirname "$0")"
echo "$*" >>calls
case $1 in
list) printf '%s\n' 'far  Two bodies: apart.' 'near  Two bodies: near.' 'heap  Several bodies: a heap.' ;;
summarize)
    [ "$ENDS" = 0 ] || exit "$ENDS"
    plan=$(find . -name 'plan-*' | sort | head -n 1)
    mkdir -p "$2" && cp "$plan" "$2/summary.csv"
    [ ! -e "plan-$((${plan##*-} + 1))" ] || rm "$plan"
    ;;
esac
MOTE
chmod +x mote

# plan NUMBER: a summary of the rows on standard input, whose fields are apart by blanks; "-": empty.
plan() {
    {
        echo "scene,method,replicates,frames,total_ns_median,total_ns_p95,error_max,heap_bytes_per_vertex,least_ns_median,least_ns_settled_sum"
        sed 's/  */,/g; s/,-/,/g'
    } >"plan-$1"
}
anew() { rm -rf out calls plan-* && mkdir out; }
ends() { # STATUS SCRIPT ARGUMENT...
    local wanted=$1 script=$2 status=0
    shift 2
    ENDS=${ENDS:-0} "$scripts/$script" "$@" >said 2>err || status=$?
    [ "$status" = "$wanted" ] || fail "$script ends with $status, not $wanted"
}
table() { # FILE: the script printed what is on standard input, and keeps it there
    cat >wanted
    diff wanted "$1" || fail "$1 is not that of the rows"
    diff wanted said || fail "$1 is not printed"
}
asked() { # WORDS...: how often the program was asked to run something with these
    local words="$*"
    grep -c -- "^run .*$words" calls || true
}

step="character_speed: times are compared as numbers, and a row without one has failed"
anew
plan 1 <<'ROWS'
walk certified 3 480 10000.0 20500 2.3e-17 83.4 - -
walk aabb-tree 3 480 1020000.0 1030000 0 - - -
walk aabb-tree 3 480 98000.0 150000 0 - - -
walk fcl-aabb 3 480 - - - - - -
walk fcl-aabb 0 0 - - - - - -
jump certified 3 480 9000.0 20000 1e-16 70 - -
jump aabb-tree 3 120 100 100 0 - - -
jump aabb-tree 2 480 200 200 0 - - -
jump aabb-tree 3 480 900000 950000 0 - - -
jump fcl-aabb 3 480 1800000 2000000 0 - - -
lost certified 0 0 - - - - - -
ROWS
ends 5 character_speed.sh ./mote quick out
table out/characters.md <<'TABLE'
| scenario | certified, median | p95 | aabb-tree / certified | its p95 | best FCL / certified | its p95 | bytes a vertex | largest error over L |
| --- | --- | --- | --- | --- | --- | --- | --- | --- |
| walk | 10.0 µs | 20.5 µs | 9.8 | 150 µs | failed | failed | 83 | 2.3e-17 |
| jump | 9.0 µs | 20.0 µs | 100 | 950 µs | 200 | 2000 µs | 70 | 1.0e-16 |
| lost | failed | failed | failed | failed | failed | failed | failed | failed |
TABLE
ENDS=4 ends 4 character_speed.sh ./mote quick out

step="auto: what is above 1.15 is measured again, with three times as many replicates"
anew
plan 1 <<'ROWS'
far certified 5 100 - - - - 1000 60000
far stream 5 100 - - - - 98000 900000
far auto 5 100 - - - - 1020 66000
near certified 5 100 - - - - 98000 4000000
near stream 5 100 - - - - 20000 900000
near auto 5 100 - - - - 23100 900000
ROWS
sed 's/^near,\(.*\),5,/near,\1,15,/; s/,23100,/,22900,/' plan-1 >plan-2
ends 0 auto.sh ./mote quick out
table out/auto.txt <<'TABLE'
µs a frame    certified     stream       auto   median      sum
far                1.00      98.00       1.02    1.020    1.100
near              98.00      20.00      22.90    1.145    1.000
2 scenarios, 0 above 1.15
TABLE
[ "$(asked near --replicates 15)$(asked far --replicates 15)$(asked --replicates 5)" = 102 ] || fail "$(cat calls)"

step="auto: what stays above 1.15 fails"
rm plan-*
sed 's/,22900,/,23100,/' out/summary.csv >plan-1
ends 1 auto.sh ./mote quick out
grep -qx 'near .* 1.155    1.000  above 1.15' out/auto.txt || fail "$(cat out/auto.txt)"
grep -qx '2 scenarios, 1 above 1.15' said || fail "$(cat said)"

step="auto: a method that failed, or whose replicates are fewer, has no ratio; times below that of the clock are none"
anew
plan 1 <<'ROWS'
far certified 5 100 - - - - 19 900
far stream 5 100 - - - - 98000 900000
far auto 5 100 - - - - 3 800
near certified 5 100 - - - - 98000 4000000
near stream 4 100 - - - - 20000 900000
near auto 5 100 - - - - 23000 900000
ROWS
ends 5 auto.sh ./mote quick out
table out/auto.txt <<'TABLE'
µs a frame    certified     stream       auto   median      sum
far                0.02      98.00       0.00    1.000    0.889
near              98.00     failed      23.00   failed   failed
2 scenarios, 0 above 1.15, 1 failed
TABLE
[ "$(asked near --replicates 15)" = 1 ] || fail "what failed is not measured again: $(cat calls)"
ENDS=4 ends 4 auto.sh ./mote quick out
ONLY=nothing ends 2 auto.sh ./mote quick out

step="ratios: all methods of a case take turns, equally often"
anew
plan 1 <<'ROWS'
jump stream 5 480 - - - - 32060.4 -
jump aabb-tree 5 480 - - - - 61060 -
jump fcl-aabb 5 480 - - - - 1020000 -
jump fcl-aabb 5 480 - - - - 383700 -
ROWS
plan 2 <<'ROWS'
still stream 5 100 - - - - 4380 -
still aabb-tree 5 100 - - - - 11190 -
still fcl-aabb 2 100 - - - - 100 -
ROWS
ONLY='^jump$\|^still$' ends 5 ratios.sh ./mote '' out
table out/ratios.txt <<'TABLE'
µs a frame            stream   aabb-tree    fcl-aabb   to tree    to FCL
jump                   32.06       61.06      383.70      1.90      12.0
still                   4.38       11.19      failed      2.55    failed
TABLE
[ "$(asked)" = 2 ] || fail "a case has more than one run: $(cat calls)"
all='--stride 1 --replicates 5 --method stream --method aabb-tree:positions=given'
[ "$(asked "$all --method fcl-aabb:seed=previous,queue=2|64,positions=given")" = 2 ] || fail "$(cat calls)"
mkdir -p results/records/0123456789/ratios
cp out/ratios.txt results/records/0123456789/ratios
echo '{"ended": "2027-03-01"}' >results/records/0123456789/ratios/study.json
(cd "$scripts" && /usr/bin/python3 -B -c "
from pathlib import Path
from tables.streamed import ratios_table
print(*ratios_table(Path('$work')), sep='\n')") >documents
grep -qx '| jump | 32.1 | 61.1 | 384 | 1.90 | 12.0 |' documents || fail "$(cat documents)"
grep -qx '| still | 4.38 | 11.2 | failed | 2.55 | failed |' documents || fail "$(cat documents)"
ONLY='1m-leaf' ends 5 ratios.sh ./mote '' out
[ "$(asked --replicates 3)" = 1 ] || fail "$(cat calls)"
ENDS=4 ONLY='^jump$' ends 4 ratios.sh ./mote '' out
ONLY=nothing ends 2 ratios.sh ./mote '' out

step="a summary without the columns, or without a row, is refused"
anew
echo 'scene,method,replicates,frames' >plan-1
ONLY='^jump$' ends 4 ratios.sh ./mote '' out
grep -q 'out/jump has 0 scenes' err || fail "$(cat err)"
echo 'jump,stream,5,100' >>plan-1
ONLY='^jump$' ends 4 ratios.sh ./mote '' out
grep -q "least_ns_median" err || fail "$(cat err)"
for script in character_speed.py auto.py ratios.py; do ends 2 "$script"; done
echo "study_tables.sh: all tables are right"
