#!/bin/sh
# peers.sh RUN PAGE: writes the tables of a run of `make engines` into PAGE (docs/peers.md), between its two lines
# of marks, with the commit, the day and the machine of the run.
set -eu
run=$1
page=$2
manifest=$run/manifest.json
begins='<!-- make engines writes from here -->'
ends='<!-- to here -->'
[ -f "$run/summary.csv" ] && [ -f "$manifest" ] || {
    echo "peers.sh: $run is no finished run of make engines" >&2
    exit 4
}
for mark in "$begins" "$ends"; do
    grep -qxF -e "$mark" "$page" || { echo "peers.sh: $page has no line '$mark'" >&2; exit 4; }
done
value() { sed -nE "s/^ *\"$1\": (\"([^\"]*)\"|([a-z0-9]+)),?$/\2\3/p" "$manifest" | head -n 1; }
dirty=
[ "$(value dirty)" = false ] || dirty=' with changes'
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
{
    echo
    echo "Measured on $(value started | cut -c 1-10) with commit $(value commit | cut -c 1-8)$dirty, $(value processor)."
    echo
    awk -f "$(dirname "$0")/peers.awk" "$run/summary.csv"
    echo
} >"$work/tables"
awk -v text="$work/tables" -v begins="$begins" -v ends="$ends" '
    $0 == ends { skipping = 0 }
    !skipping
    $0 == begins { while ((getline line < text) > 0) print line; skipping = 1 }' "$page" >"$work/page"
cat "$work/page" >"$page"
