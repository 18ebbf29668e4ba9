#!/usr/bin/env bash
# make coverage: runs the tests of a build that counts branches (preset coverage), and prints the
# share of the branches of core and of harness that they take. Fails below 99 and 94 %.
#   coverage.sh BUILD JOBS OUT [TESTS]   TESTS: only these (ctest -R), added to what has been counted
# OUT gets coverage.html (line by line), coverage.csv (a row a file), coverage.tsv, tests.log.
# Branches of exceptions that are never thrown and lines marked GCOVR_EXCL_* are left out; each mark
# gives the reason why no test can get there.
set -u
build=$1 jobs=$2 out=$3 only=${4:-}
mkdir -p "$out"
[ -n "$only" ] || find "$build" -name '*.gcda' -delete
(cd "$build" && ctest -j "$jobs" --output-on-failure ${only:+-R "$only"}) >"$out/tests.log" 2>&1 ||
    { sed -n '/tests failed/,$p' "$out/tests.log"; failed=1; }
# Notes of sources that have moved or gone would be warned of; object files know their source by their path.
find "$build" -name '*.gcno' | while read -r notes; do
    source=${notes#*.dir/}
    [ -e "${source%.gcno}" ] || [ -e "tests/${source%.gcno}" ] || rm -f "$notes" "${notes%.gcno}.gcda"
done
# Threads count without a lock; if a count becomes negative for this reason, its line is left out.
gcovr --gcov-ignore-parse-errors --root . --filter '(core|harness)/' -j "$jobs" \
    --exclude-throw-branches --exclude-unreachable-branches \
    --csv "$out/coverage.csv" --html-details "$out/coverage.html" "$build" || exit 1
awk -F, -v tsv="$out/coverage.tsv" '
    NR > 1 { sub(/\/.*/, "", $1); all[$1] += $5; taken[$1] += $6 }
    END {
        least["core"] = 99; least["harness"] = 94
        printf "%-10s %10s %10s %8s %8s\n", "folder", "branches", "taken", "%", "least"
        for (i = 1; i <= split("core harness", folder, " "); ++i) {
            f = folder[i]
            share = all[f] ? 100 * taken[f] / all[f] : 0
            printf "%-10s %10d %10d %8.2f %8d\n", f, all[f], taken[f], share, least[f]
            printf "%s\t%d\t%d\n", f, all[f], taken[f] >tsv
            if (share < least[f]) low = 1
        }
        exit low
    }' "$out/coverage.csv" && [ -z "${failed:-}" ]
