#!/usr/bin/env bash
# documents.sh ROOT WORK: numbers in the documents of ROOT are those of the stored results, and
# harness/scripts/documents.py notices where they are not, in a copy below WORK.
set -euo pipefail
root=$1 work=$2
fail() { echo "documents: $*" >&2; cat "$work/said" >&2; exit 1; }
rm -rf "$work"
mkdir -p "$work/results" "$work/harness" "$work/tests"
: >"$work/said"
check() { # STATUS [--check]
    local wanted=$1 status=0
    shift
    /usr/bin/python3 "$root/harness/scripts/documents.py" "$@" >"$work/said" 2>&1 || status=$?
    [ "$status" = "$wanted" ] || fail "$* ends with $status, not $wanted"
}
says() { grep -q -- "$1" "$work/said" || fail "does not say: $1"; }

check 0 "$root" --check
check 2 "$root" --chek
cp -r "$root/README.md" "$root/docs" "$work"
cp -r "$root/results/reference" "$root/results/records" "$root/results/fuzz.csv" "$work/results"
cp -r "$root/harness/scripts" "$work/harness"
cp -r "$root/tests/corpus" "$work/tests"

# A cell of a table, typed by hand, is found and written again.
sed -i 's/^| tt | [0-9.]* (/| tt | 99 (/' "$work/docs/findings.md"
check 1 "$work" --check
says 'docs/findings.md: a table is not that of its source'
check 0 "$work"
cmp "$root/docs/findings.md" "$work/docs/findings.md"

# So is a number in a sentence, which nothing but a hand can write.
sed -i 's/processes a method/times a method/' "$work/README.md"
check 1 "$work"
says 'README.md: by the stored results it should say: (frames 950 to 1149, 38 of them in contact, 30 processes a method,'
cp "$root/README.md" "$work"

# A table without an end is refused, and what follows it stays.
sed -i '/^<!-- to here -->$/d' "$work/docs/findings.md"
cp "$work/docs/findings.md" "$work/findings.md"
check 4 "$work"
says 'there is no line <!-- to here -->'
cmp "$work/findings.md" "$work/docs/findings.md"
cp "$root/docs/findings.md" "$work/docs"

# A newer record takes the place of what was there before; its table says when its sources have changed.
record=$work/results/records/0123456789/dynamics
newest=$(cd "$root/harness/scripts" && /usr/bin/python3 -B -c "from pathlib import Path; from tables import impacts, records
print(records.file_of(Path('$work'), impacts.DYNAMICS))")
mkdir -p "$record"
cp "$newest" "$record"
describe() { # HASH ENDED
    printf '{\n"study": "dynamics",\n"commit": "0123456789",\n"ended": "%s",\n"failed": 0,\n"parts_done": 1,\n"sources_hash": "%s"\n}\n' \
        "$2" "$1" >"$record/study.json"
}
describe 0000000000000000 2027-03-01T12:00:00.000Z
check 1 "$work" --check
says 'docs/findings.md: a table is not that of its source'
table=$work/harness/scripts/studies.tsv
sources="core harness/loop"
awk -F '\t' -v OFS='\t' -v sources="$sources" '$1 == "dynamics" { $5 = sources; print }' "$table" >"$work/row"
mv "$work/row" "$table"
(
    cd "$work"
    for source in $sources; do mkdir -p "$source" && echo 1 >"$source/one"; done
    git init -q .
    git -c core.excludesFile=/dev/null add .
    git -c user.email=a@b.c -c user.name=somebody commit -qm first
)
check 0 "$work"
line='Recorded on 2027-03-01, \[0123456789\](../results/records/0123456789/dynamics)'
grep -qx "$line; its sources have changed since\." "$work/docs/findings.md" || fail "not stale: $(grep Recorded "$work/docs/findings.md")"

# Fresh: the document may not call it stale.
# shellcheck disable=SC2086 # a list of paths
hash=$(cd "$work" && git ls-files -s -- $sources | git hash-object --stdin | cut -c 1-16)
describe "$hash" 2027-03-02T12:00:00.000Z
check 1 "$work" --check
check 0 "$work"
grep -qx "${line/01,/02,}\." "$work/docs/findings.md" || fail "not fresh: $(grep Recorded "$work/docs/findings.md")"

# Parts that are missing make a study stale, but its sources are the same.
sed -i 's/"parts_done": 1/"parts_done": 0/' "$record/study.json"
check 0 "$work" --check

# Checks of a newer record take the place of an older one's, and the table says where they are from.
record=$work/results/records/0123456789/metamorphic
mkdir -p "$record"
printf 'metamorphic: refined\t7000000\t3\n' >"$record/checks.tsv"
printf '{\n"study": "metamorphic",\n"commit": "0123456789",\n"ended": "2027-03-02T12:00:00.000Z",\n"sources_hash": "0"\n}\n' \
    >"$record/study.json"
check 0 "$work"
grep -qx '| metamorphic: refined | 7,000,000 | 3 | 2027-03-02 |' "$work/docs/findings.md" || fail 'the table has no record of checks'
grep -q '^Recorded: .*\[metamorphic\](../results/records/0123456789/metamorphic)' "$work/docs/findings.md" ||
    fail "no heading: $(grep Recorded: "$work/docs/findings.md")"

describe_parts() { # STUDY PARTS DONE
    printf '{\n"study": "%s",\n"commit": "0123456789",\n"ended": "2027-03-02T12:00:00.000Z",\n"parts": %s,\n"parts_done": %s\n}\n' \
        "$@" >"$record/study.json"
}

# Some parts of a study are shown while there is no whole record of it. They do not take the place of one, which is said
# to be of older sources then, unless something failed in them.
record=$work/results/records/0123456789/answers
whole=$work/results/records/9876543210/answers
rm -rf "$work"/results/records/*/answers
mkdir -p "$record" "$whole"
row='one hash over all answers: builds, threads and runs'
describe_parts answers 7 2
printf '%s\t28\t0\n' "$row" >"$record/checks.tsv"
check 0 "$work"
grep -q "^| $row | 28 | 0 | 2027-03-02 |" "$work/docs/findings.md" || fail 'the parts of a record are not shown'
printf '%s\t777\t0\n' "$row" >"$whole/checks.tsv"
sed 's/"parts_done": 2/"parts_done": 7/; s/-03-02T/-03-01T/' "$record/study.json" >"$whole/study.json"
check 0 "$work"
grep -q "^| $row | 777 | 0 | 2027-03-01 |" "$work/docs/findings.md" || fail 'the whole record is not shown'
# shellcheck disable=SC2016
grep -q '^Recorded: .*\[answers\](../results/records/9876543210/answers).* The sources of .*`answers`.* have changed' \
    "$work/docs/findings.md" || fail "the whole record is not said to be old: $(grep Recorded: "$work/docs/findings.md")"
printf '%s\t1\t1\n' "$row" >"$record/checks.tsv"
check 0 "$work"
grep -q "^| $row | 1 | 1 | 2027-03-02 |" "$work/docs/findings.md" || fail 'a failure is not shown'
rm -r "$record" "$whole"

# The parts of a record are summed, and the table says how many of how many there are.
record=$work/results/records/0123456789/mutation-skin
mkdir -p "$record"
printf 'skin\t1000\t800\t0\n' >"$record/mutation-1.tsv"
printf 'skin\t1000\t900\t100\n' >"$record/mutation-2.tsv"
describe_parts mutation-skin 10 2
page=docs/reliability.md
check 1 "$work" --check
says "$page: a table is not that of its source"
check 0 "$work"
grep -qx '| skin | 2,000 | 1,700 | 100 | 89.5 % | 2027-03-02, 0123456, 2 of 10 samples |' "$work/$page" ||
    fail "no sum of parts: $(grep '^| skin' "$work/$page")"
grep -q '^Recorded: .*\[mutation-skin\](../results/records/0123456789/mutation-skin)' "$work/$page" ||
    fail "no heading: $(grep Recorded: "$work/$page")"

# What no record has, and what cannot be read, is said, and nothing is written.
mv "$work"/results/records/*/gate "$work"
check 4 "$work"
says 'no record in results/records has gate/'
mv "$work/gate" "$work/results/records/0123456789"
rm "$work/results/reference/summary.json"
check 4 "$work"
says 'summary.json'
