#!/usr/bin/env bash
# log_fuzz.sh FUZZ.tsv [COMMIT [DATE]]: adds the lines of fuzz.sh to results/fuzz.csv, where the hours of fuzzing add up
# over commits, and writes the tables of documents again. COMMIT and DATE: of what was fuzzed (HEAD, today).
set -eu
here=$(git rev-parse --short HEAD)
[ -z "$(git status --porcelain -- core harness baselines datasets cmake CMakeLists.txt)" ] || here=$here+
awk -F'\t' -v OFS=, -v commit="${2:-$here}" -v date="${3:-$(date -u +%Y-%m-%d)}" \
    '{ print date, commit, $1, $2, $3, $4 }' "$1" >>results/fuzz.csv

# Status 1: a sentence does not agree, and is left to a hand.
harness/scripts/documents.py . || [ $? = 1 ]
