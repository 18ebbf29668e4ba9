#!/usr/bin/env bash
# Adds the results of reliability studies to results/reference, as committed evidence, and
# writes results/reference/reliability.md again.
#   record.sh CHECKS.tsv [COMMIT [DATE]]      lines of {check, tried, failed}, as make reliability
#                                             leaves them; COMMIT and DATE: of what was tested
#   record.sh --page                          writes the page again from what is stored
#   record.sh --fuzz FUZZ.tsv [COMMIT [DATE]] lines of fuzz.sh, added to tests/corpus/log.csv
#   record.sh --soak SOAK.csv [COMMIT [DATE]] of make soak, added to results/reference/soak.csv
#   record.sh --mutation MUTATION.tsv [COMMIT [DATE]] of make mutation: lines of {module, mutants,
#                                             killed, equivalent}; the last of each module is kept
#   record.sh --coverage COVERAGE.tsv [COMMIT [DATE]] of make coverage: {folder, branches, taken}
# results/reference/reliability.csv holds the last line of every check.
set -eu
kind=checks
case $1 in
--fuzz | --soak | --mutation | --coverage | --page)
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
elif [ "$kind" = checks ]; then
    # Fuzzing is summed in a log of its own; names have commas.
    sed -E '/^fuzz: /d; s/^([^\t]*)/"\1"/' "$1" >"$csv.new"
    keep_last $csv "$csv.new"
    rm "$csv.new"
fi

# Errors over L in all runs: the share of queries that are exact or nearly exact, by method. Method
# names are quoted, because they have commas.
distribution() {
    echo
    echo "| errors on random scenarios | queries | exact | below 1e-6 L | 1e-3 L | 1e-2 L | 0.1 L | largest / L | contacts missed |"
    echo "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |"
    sed 1d $errors | awk -F'"' '
        {
            split($3, v, ",")
            if (!($2 in queries)) order[++n] = $2
            queries[$2] += v[2]; missed[$2] += v[3]
            if (v[5] > largest[$2]) largest[$2] = v[5]
            for (k = 0; k < 18; ++k) count[$2, k] += v[6 + k]
        }
        function share(method, last,    k, sum) {
            for (k = 0; k <= last; ++k) sum += count[method, k]
            return sum == queries[method] ? "100 %" : sprintf("%.2f %%", 100 * sum / queries[method])
        }
        END {
            for (i = 1; i <= n; ++i) {
                m = order[i]
                printf "| `%s` | %d | %s | %s | %s | %s | %s | %.2g | %d |\n", m, queries[m],
                    share(m, 4), share(m, 10), share(m, 13), share(m, 14), share(m, 15), largest[m], missed[m]
            }
        }'
}
# Mutants by module; those that change no promised answer count neither way.
mutation() {
    echo
    echo "| mutants of | tried | killed | change nothing | score | date, commit |"
    echo "| --- | ---: | ---: | ---: | ---: | --- |"
    sed 1d $mutants | awk -F, '{
        printf "| %s | %d | %d | %d | %.1f %% | %s, %s |\n", $1, $2, $3, $4,
            100 * $3 / ($2 - $4), $5, $6
    }'
}
coverage() {
    echo
    echo "| branches of | in all | taken | share | date, commit |"
    echo "| --- | ---: | ---: | ---: | --- |"
    sed 1d $branches | awk -F, '{
        printf "| %s | %d | %d | %.2f %% | %s, %s |\n", $1, $2, $3, 100 * $3 / $2, $4, $5
    }'
}
table() {
    echo "| check | tried | failed | date, commit |"
    echo "| --- | ---: | ---: | --- |"
    sed 1d $csv | sed -E 's/^"([^"]*)",([0-9]*),([0-9]*),([^,]*),(.*)$/| \1 | \2 | \3 | \4, \5 |/'
    # Fixed findings are kept in the corpus as found-*: the other ones are open. Every target has a
    # corpus, so that none is left out.
    sed 1d $log | awk -F, -v corpus="$(printf '%s ' tests/corpus/fuzz_*/found-*)" \
        -v targets="$(cd tests/corpus && printf '%s ' fuzz_*/ | sed 's|fuzz_||g; s|/||g')" '
        { s[$3] += $4; e[$3] += $5; f[$3] += $6; last[$3] = $1 ", " $2 }
        END {
            count = split(targets, t, " ")
            for (i = 1; i <= count; ++i) {
                if (!e[t[i]])
                    continue
                mended = gsub("/fuzz_" t[i] "/found-[^* ]", "&", corpus)
                printf "| fuzz: %s, %.2f CPU hours in all%s | %d | %d | %s |\n", t[i],
                    s[t[i]] / 3600, mended ? ", " mended " found and mended" : "", e[t[i]],
                    f[t[i]] - mended, last[t[i]]
            }
        }'
}
page=results/reference/reliability.md
{
    cat <<'TEXT'
# Reliability

Written by `tests/scripts/record.sh`; do not edit. [docs/benchmarking.md](../../docs/benchmarking.md#reliability)
says how each of these is measured.

## What was tried, and what failed

A check tries the given number of cases and counts those that fail. The fuzzers' counts add up over all
recorded hours.

TEXT
    table
    if [ "$(wc -l <$branches)" -gt 1 ]; then
        printf '\n## Branches that the tests take\n'
        coverage
    fi
    if [ "$(wc -l <$mutants)" -gt 1 ]; then
        printf '\n## Planted errors that the tests find\n\n'
        echo 'The score leaves out errors that change nothing that is promised (tests/mutants_equivalent.txt).'
        mutation
    fi
    cat <<'TEXT'

## Errors on random scenarios

Share of the queries with an error of at most 1e-12 L (exact) and of at most the other bounds. L is the diagonal
of the larger body's bounding box at rest. `budget=60` stops early on purpose and returns a bracket, which
contains the truth.
TEXT
    distribution
} >$page.part
mv $page.part $page
