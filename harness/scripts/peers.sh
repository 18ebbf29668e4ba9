#!/bin/sh
# peers.sh RUN PAGE: writes the tables of a run of `make engines` into PAGE (docs/peers.md), between its two lines
# of marks, with the commit, the day and the machine of the run.
set -eu
run=$1
page=$2
fail() { echo "peers.sh: $*" >&2; exit 4; }
[ -f "$run/summary.csv" ] && [ -f "$run/manifest.json" ] || fail "$run is no finished run of make engines"
begins='<!-- make engines writes from here -->'
ends='<!-- to here -->'
for mark in "$begins" "$ends"; do
    grep -qxF -e "$mark" "$page" || fail "$page has no line '$mark'"
done
value() { sed -nE "s/^ *\"$1\": (\"([^\"]*)\"|([a-z0-9]+)),?$/\2\3/p" "$run/manifest.json" | head -n 1; }
tables=$(mktemp)
trap 'rm -f "$tables" "$tables.page"' EXIT
{
    echo "$begins"
    echo
    dirty=
    [ "$(value dirty)" = false ] || dirty=' with changes'
    echo "Measured on $(value started | cut -c 1-10) with commit $(value commit | cut -c 1-8)$dirty, $(value processor)."
    echo
    awk -f "$(dirname "$0")/peers.awk" "$run/summary.csv"
    echo
} >"$tables"
awk -v tables="$tables" -v begins="$begins" -v ends="$ends" '
    $0 == begins { while ((getline line < tables) > 0) print line; skipping = 1 }
    $0 == ends { skipping = 0 }
    !skipping' "$page" >"$tables.page"
cat "$tables.page" >"$page"
