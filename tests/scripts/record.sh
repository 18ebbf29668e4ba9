#!/usr/bin/env bash
# Adds the results of reliability studies to results/reference, as committed evidence of what no record has
# (make record), and writes the tables of documents again.
#   record.sh CHECKS.tsv [COMMIT [DATE]]      lines of {check, tried, failed}, as make reliability
#                                             leaves them; COMMIT and DATE: of what was tested
#   record.sh --fuzz FUZZ.tsv [COMMIT [DATE]] lines of fuzz.sh, added to tests/corpus/log.csv
#   record.sh --soak SOAK.csv [COMMIT [DATE]] of make soak, added to results/reference/soak.csv
#   record.sh --mutation MUTATION.tsv [COMMIT [DATE]] of make mutation: lines of {module, mutants,
#                                             killed, equivalent}; the last of each module is kept
#   record.sh --coverage COVERAGE.tsv [COMMIT [DATE]] of make coverage: {folder, branches, taken}
# results/reference/reliability.csv holds the last line of every check.
set -eu
kind=checks
case $1 in
--fuzz | --soak | --mutation | --coverage)
    kind=${1#--}
    shift
    ;;
esac
here=$(git rev-parse --short HEAD)
if [ -n "$(git status --porcelain -- core harness baselines datasets cmake CMakeLists.txt)" ]; then
    here=$here+
fi
commit=${2:-$here}
date=${3:-$(date -u +%Y-%m-%d)}
csv=results/reference/reliability.csv log=tests/corpus/log.csv errors=results/reference/soak.csv
mutants=results/reference/mutation.csv branches=results/reference/coverage.csv
[ -f $log ] || echo "date,commit,target,cpu_seconds,executions,findings" >$log
[ -f $csv ] || echo "check,tried,failed,date,commit" >$csv
soak_header() {
    printf 'date,commit,method,queries,missed,false_contacts,largest_error'
    for k in 16 15 14 13 12 11 10 9 8 7 6 5 4 3 2 1 0; do printf ',below_1e-%s' $k; done
    echo ',more'
}
[ -f $errors ] || soak_header >$errors
[ -f $mutants ] || echo "module,mutants,killed,equivalent,date,commit" >$mutants
[ -f $branches ] || echo "folder,branches,taken,date,commit" >$branches
# Adds the lines of a TSV to a CSV. Of each name, which may be quoted, the last line is kept, in the
# place of the first.
keep_last() { # CSV TSV
    tr '\t' , <"$2" | sed "s/\$/,$date,$commit/" | cat "$1" - | awk '
        { match($0, /^("[^"]*"|[^,]*)/); name = substr($0, 1, RLENGTH) }
        !(name in last) { order[++n] = name }
        { last[name] = $0 }
        END { for (i = 1; i <= n; ++i) print last[order[i]] }' >"$1.part"
    mv "$1.part" "$1"
}
if [ "$kind" = soak ]; then
    sed "s/^/$date,$commit,/" "$1" >>$errors
elif [ "$kind" = mutation ]; then
    keep_last $mutants "$1"
elif [ "$kind" = coverage ]; then
    keep_last $branches "$1"
elif [ "$kind" = fuzz ]; then
    awk -F'\t' -v d="$date" -v c="$commit" \
        '{ printf "%s,%s,%s,%d,%d,%d\n", d, c, $1, $2, $3, $4 }' "$1" >>$log
else
    # Fuzzing is summed in a log of its own; names have commas.
    sed -E '/^fuzz: /d; s/^([^\t]*)/"\1"/' "$1" >"$csv.new"
    keep_last $csv "$csv.new"
    rm "$csv.new"
fi

# Status 1: a sentence does not agree, and is left to a hand.
harness/scripts/documents.py . || [ $? = 1 ]
