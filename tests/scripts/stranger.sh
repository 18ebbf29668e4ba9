#!/bin/bash
# stranger.sh: follows docs/extending.md in a copy of the sources to add a method, a field and a
# scenario: each file dropped in, one `make build`, one run, and all of them are in the table.
set -euo pipefail
tests=$(realpath "$(dirname "$0")")
. "$(dirname "$0")/work.sh"
# No pipe into grep -q: it exits at the first match, and the writer would fail.

cd "$tests/../.."
git ls-files -z --cached --others --exclude-standard | xargs -0 cp --parents -t "$work"
cd "$work"
documented() { "$tests/documented.sh" "$1" > "$1"; }
documented core/sampled.c
documented core/bend.c
documented datasets/scenarios/bending.json

documented commands
bash -e commands > table 2> log || { tail -40 log table; fail "the documented commands fail"; }
if grep -n "warning: " log | grep -v "machine is busy"; then fail "the documented files have warnings"; fi
sed -n '/^bending:/,$p' table

grep -q '^sampled: ' <<< "$(build/mote list methods)" || fail "the method is not listed"
grep -q '^bend: ' <<< "$(build/mote list fields)" || fail "the field is not listed"
grep -q '^bending ' <<< "$(build/mote list scenarios)" || fail "the scenario is not listed"
for row in 'sampled ' 'certified ' 'brute-force '; do
    grep -q "^$row" table || fail "no row $row in the table"
done

# Exact methods agree on the bent body, whose distance varies; a sample of the vertices is further
# apart than the surfaces, by some edge lengths at most.
build/mote summarize results/bending --format csv > rows.csv
column() { awk -F, -v name="$1" 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == name) k = i; next }
    { gsub(/"/, ""); print $4, $k }' rows.csv; }
column error_max | awk '
    NF != 2 { next }
    $1 == "certified" || $1 == "brute-force" { if ($2 > 1e-12) exit 1; ++seen }
    $1 == "sampled" { if ($2 <= 1e-6 || $2 > 0.2) exit 1; ++seen }
    END { if (seen != 3) exit 1 }' || { column error_max; fail "errors"; }
# frame,deform_ns,update_ns,query_ns,distance,...
LC_ALL=C sort -t, -k5,5g results/bending/cells/bending-certified-r1-*.csv | awk -F, '
    $1 == "frame" { next } low == "" { low = $5 } { high = $5 }
    END { if (!(high - low > 0.1)) exit 1 }' || fail "the body does not bend"
echo "a method, a field and a scenario from docs/extending.md alone: built, run, in the table"
