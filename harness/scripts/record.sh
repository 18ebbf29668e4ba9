#!/bin/sh
# record.sh RUN RECORDS: keeps a run's summary.json and manifest.json in RECORDS/DATE-NAME-COMMIT (results/README.md).
set -eu
run=$1
fail() { echo "record.sh: $*" >&2; exit 4; }
for file in summary.json manifest.json; do
    [ -f "$run/$file" ] || fail "$run/$file is not there; name the directory of a run (OUT=DIR)"
done
value() { sed -nE "s/^ *\"$1\": (\"([^\"]*)\"|([a-z]+)),?$/\2\3/p" "$run/manifest.json" | head -n 1; }
commit=$(value commit)
[ -n "$commit" ] && [ "$(value dirty)" = false ] || fail "$run was not measured by the build of a commit"
started=$(value started)
[ -n "$started" ] || fail "$run/manifest.json does not say when the run began"
name=$(basename "$(realpath "$run")" | tr -c 'A-Za-z0-9\n' '-')
record=$2/$(echo "$started" | cut -c 1-10)-$name-$(echo "$commit" | cut -c 1-8)
mkdir -p "$record"
cp "$run/summary.json" "$run/manifest.json" "$record"
echo "$record"
