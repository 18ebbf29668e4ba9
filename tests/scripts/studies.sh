#!/bin/bash
# studies.sh STUDIES: does harness/scripts/studies.sh (STUDIES) run what is stale, and only that? In a
# repository of two studies of its own: fresh, stale, interrupted, failed, cut short, and bad tables.
set -euo pipefail
studies=$(realpath "$1")
. "$(dirname "$0")/work.sh"
export JOBS=1
step=start
shown="out err"
cd "$work"
git init -q repository
cd repository
git config user.email a@b.c
git config user.name somebody
mkdir core plots
echo 1 >core/a.c
echo 1 >core/b.c
echo 1 >plots/c.gp
row() { # NAME PLACE MINUTES PARTS SOURCES FILES COMMAND
    local IFS=$'\t'
    echo "$*"
}
{
    echo "# a comment"
    row sums beside 30 3 core 'sum.csv log*' "\"$work/run\" sums"
    row pictures beside 60 1 plots '*.csv figures/*.svg other/*.csv' "\"$work/run\" pictures && printf '\\t' >\"\$OUT/tab\""
} >table.tsv
printf 'work/\nrecords/\n' >.gitignore
git add . && git commit -qm first
# Each run is noted in calls; the file fail makes a study fail, and kill ends it as a signal does.
cat >"$work/run" <<'RUN'
#!/bin/sh
echo "$1 $PART${ONLY+ with ONLY}${JOBS+ with JOBS}" >>"$(dirname "$0")/calls"
[ ! -e "$(dirname "$0")/kill" ] || [ "$PART" != 2 ] || kill -9 $$
[ ! -e "$(dirname "$0")/fail" ] || exit 1
rm -rf "$OUT" # as some commands do with their folder
mkdir -p "$OUT"
printf 'a, b\t10\t0\nc\t%s\t1\n' "$PART" >"$OUT/checks.tsv"
echo "$1 \"$PART\"" >"$OUT/sum.csv"
mkdir -p "$OUT/figures"
echo svg >"$OUT/figures/one.svg"
mkdir -p "$OUT/other" "$OUT/cells"
echo 2 >"$OUT/other/sum.csv"
echo 1 >"$OUT/cells/cell.csv"
RUN
chmod +x "$work/run"
: >"$work/calls"
run() { # STATUS [ARGUMENT]
    local wanted=$1 status=0
    shift
    "$studies" table.tsv records work "$@" >"$work/out" 2>"$work/err" || status=$?
    [ "$status" = "$wanted" ] || fail "status $status, not $wanted"
}
calls() { [ "$(sort "$work/calls" | tr '\n' ,)" = "$1" ] || fail "calls: $(tr '\n' , <"$work/calls")"; : >"$work/calls"; }

step="everything is stale at first"
run 1 list
says "sums              1.5 h  beside  never recorded"
says "2 stale, 2.5 h"
calls ""

step="a killed part ends the run, and what passed is not run again"
touch "$work/kill"
run 4
tells "sums was ended"
calls "sums 1,sums 2,"
rm "$work/kill"
run 0
calls "pictures 1,sums 2,sums 3,"
says "nothing is stale"
head=$(git rev-parse --short=10 HEAD)
[ "$(cat "records/$head/sums/checks.tsv")" = "$(printf 'a, b\t30\t0\nc\t6\t3')" ] || fail "sums of checks"
[ -f "records/$head/sums/log.txt" ] || fail "the log is not kept"
[ -f "records/$head/pictures/one.svg" ] || fail "a file of a folder is not kept"
[ -f "records/$head/pictures/other-sum.csv" ] || fail "a file of a folder replaces another"
[ ! -e "records/$head/pictures/cell.csv" ] || fail "keeps a file of a folder that the table does not name"
[ ! -e "records/$head/sums/one.svg" ] || fail "keeps a file that the table does not name"
python3 -c 'import json, sys; s = json.load(open(sys.argv[1])); assert s["parts_done"] == 3 and s["failed"] == 0 and s["study"] == "sums"' \
    "records/$head/sums/study.json" || fail "study.json"
python3 -c 'import json, sys; assert json.load(open(sys.argv[1]))["command"].endswith(sys.argv[2]), json.load(open(sys.argv[1]))' \
    "records/$head/pictures/study.json" "printf '\\t' >\"\$OUT/tab\"" || fail "a command with a backslash"

step="nothing is run again while the sources stay"
run 0
calls ""

step="only what exercises a changed file is stale"
echo 2 >core/b.c
run 1 list
says "core/b.c changed since $head"
run 4
tells "not committed"
git commit -qam second
run 1 list
says "1 stale"
touch "$work/fail"
run 1
calls "sums 1,sums 2,sums 3,"
says "failed at"
rm "$work/fail"
run 0
calls "sums 1,sums 2,sums 3,"

step="a text beside the sources, and another list of the same files, make nothing stale"
echo text >core/README.md
git add . && git commit -qm "a text"
sed -i "s/30\t3\tcore\t/30\t3\tcore table.tsv\t/" table.tsv
git commit -qam "another list"
record=records/$(git rev-parse --short=10 HEAD~2)/sums/study.json
sed -i.kept 's/"commit": "[^"]*"/"commit": "0123456789"/' "$record"
run 1 list
says "other sources than at 0123456789"
mv "$record.kept" "$record"
run 1 list
says "table.tsv changed since"
sed -i "s/core table.tsv/core core\/a.c/" table.tsv
git commit -qam "the same files"
run 0 list
calls ""

sed -i -e "s/core core\/a.c/core @more/" -e "1a @more\tcore\/a.c core\/b.c" table.tsv
git commit -qam "the same files by a name"
run 0 list
sed -i.kept 's/core @more/core @other/' table.tsv
run 4 list
tells "table.tsv: sums: there is no line @other"
mv table.tsv.kept table.tsv
calls ""

step="other comments in a C file make nothing stale; code within a line of them does"
printf '// 1 as well\n1 /* was\n2 */\n\n' >core/b.c
git commit -qam "b.c is 1 with comments"
ONLY=sums run 0
calls "sums 1,sums 2,sums 3,"
printf '1 // one\n' >core/b.c
git commit -qam "another comment"
ONLY=sums run 0 list
printf '1 // one\n2\n' >core/b.c
ONLY=sums run 1 list
says "core/b.c changed since"
git checkout -q core/b.c
ONLY=sums run 0
calls ""
head=$(git rev-parse --short=10 HEAD)
grep -q "\"same_commit\": \"$head\"" records/*/sums/study.json || fail "the record does not say for which commit it holds"

step="other comments in a shell script make nothing stale; code, its first line and what it prints do"
script() { # FIRST LAST
    printf '%s\n# Says it.\ncat <<TEXT # so\n# %s\nTEXT\n' "$1" "$2" >core/say.sh
}
script '#!/bin/sh' one
git add core/say.sh && git commit -qm "a script"
ONLY=sums run 0
calls "sums 1,sums 2,sums 3,"
sed -i -e "2s/.*/# Says what it has to say./" -e "s/ # so//" core/say.sh
ONLY=sums run 0 list
script '#!/bin/bash' one
ONLY=sums run 1 list
says "core/say.sh changed since"
script '#!/bin/sh' two
ONLY=sums run 1 list
says "core/say.sh changed since"
git checkout -q core/say.sh
calls ""

step="a part that would end too late is not begun"
echo 2 >plots/c.gp
git commit -qam third
HOURS=0.5 run 1
tells "not finished within 0.5 h: pictures"
HOURS=1.5 run 0
calls "pictures 1,"

step="parts of a record go on where WORK is lost"
echo 9 >core/a.c
git commit -qam "of parts"
touch "$work/kill"
run 4
calls "sums 1,sums 2,"
rm -r "$work/kill" work
first=$(git rev-parse --short=10 HEAD)
echo 1 >plots/d.gp
git add . && git commit -qm "of other files"
ONLY=sums run 1 list
says "sums              1.0 h  beside  1 of 3 parts recorded, at $first"
ONLY=sums run 0
calls "sums 2,sums 3,"
record=records/$(git rev-parse --short=10 HEAD)/sums
[ "$(cat "$record/checks.tsv")" = "$(printf 'a, b\t30\t0\nc\t6\t3')" ] || fail "sums of checks"
python3 -c 'import json, sys
s = json.load(open(sys.argv[1]))
assert s["parts_passed"] == "1 2 3" and s["parts_done"] == 3 and s["failed"] == 0 and s["continues"] == sys.argv[2]' \
    "$record/study.json" "$first" || fail "study.json"
run 0
calls "pictures 1,"

step="parts of a record with a failure are run again where WORK is lost"
echo 10 >core/a.c
git commit -qam "that fails"
touch "$work/fail"
ONLY=sums run 1
calls "sums 1,sums 2,sums 3,"
rm -r "$work/fail" work
ONLY=sums run 0
calls "sums 1,sums 2,sums 3,"

step="parts at the same time, and stopped together"
echo 3 >core/b.c
git commit -qam fourth
cp "$work/run" "$work/kept"
: >"$work/pids"
cat >"$work/run" <<'RUN'
#!/bin/sh
echo $$ >>"$(dirname "$0")/pids"
exec sleep 37
RUN
JOBS=3 setsid "$studies" table.tsv records work >"$work/out" 2>"$work/err" &
for _ in $(seq 100); do
    [ "$(wc -l <"$work/pids")" = 3 ] && break
    sleep 0.1
done
[ "$(wc -l <"$work/pids")" = 3 ] || fail "three parts do not run"
kill -TERM $!
wait $! || true
sleep 0.5
while read -r pid; do
    ! grep -q sleep "/proc/$pid/cmdline" 2>/dev/null || fail "a part goes on"
done <"$work/pids"
cp "$work/kept" "$work/run"
JOBS=3 run 0
calls "sums 1,sums 2,sums 3,"

step="C files have changed, and the program is the same"
{
    row program beside 1 1 core '*.csv' "\"$work/run\" program"
    row tested beside 1 1 'core tests' '*.csv' "\"$work/run\" tested"
} >>table.tsv
mkdir -p tests harness/scripts
echo 1 >tests/t.c
echo binary >"$work/program"
sed -i "s/^program\tbeside\t1\t1\tcore/& harness/" table.tsv
echo 1 >harness/scripts/s.sh
git add . && git commit -qm fifth
PROGRAM=$work/program run 0
calls "program 1,tested 1,"
record=records/$(git rev-parse --short=10 HEAD)/program/study.json
echo 4 >core/b.c
git commit -qam sixth
ONLY=program run 1 list
says "core/b.c changed since"
ONLY=program PROGRAM=$work/program run 0 list
! grep -q same_program "$record" || fail "list writes into a record"
ONLY="program tested" PROGRAM=$work/program run 0
calls "tested 1,"
ONLY=program run 0 list # as the record says now
echo '4 /* four */' >core/b.c
ONLY=program run 0 list # compared with the commit of that note
git checkout -q core/b.c
python3 -c 'import json, sys; assert json.load(open(sys.argv[1]))["same_program"]' "$record" || fail "$record"
echo 2 >harness/scripts/s.sh
echo 1 >harness/scripts/t.sh
git add . && git commit -qm seventh
ONLY=program PROGRAM=$work/program run 1 list
says "harness/scripts/s.sh and 1 more changed since"
git revert -n HEAD && git commit -qm eighth
ONLY=program run 0 list
echo 5 >core/b.c
git commit -qam ninth
echo other >"$work/program"
ONLY=program PROGRAM=$work/program run 1 list
says "core/b.c changed since"

step="bad input"
ONLY=sum run 2 list
tells "no study sum; there are: sums pictures"
HOURS=soon run 2 list
tells "give a number of hours"
row bad always 1 1 core - true >>table.tsv
run 4 list
tells "write NAME, alone or beside"
sed -i '$d' table.tsv
row bad alone 1 1 cores - true >>table.tsv
run 4 list
tells "there is no file in cores"
echo "studies.sh: all steps passed"
