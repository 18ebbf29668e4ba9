#!/bin/sh
# peers.sh RUN PAGE: writes the tables of a run of `make engines` into PAGE (docs/peers.md), between its two lines
# of marks, with the commit, the day and the machine of the run.
set -eu
run=$1
page=$2
. "$(dirname "$0")/marked.sh"
MANIFEST=$run/manifest.json
[ -f "$run/summary.csv" ] && [ -f "$MANIFEST" ] || {
    echo "peers.sh: $run is no finished run of make engines" >&2
    exit 4
}
tables=$(mktemp)
trap 'rm -f "$tables"' EXIT
awk -f "$(dirname "$0")/peers.awk" "$run/summary.csv" >"$tables"
put_marked "$tables" "$page" '<!-- make engines writes from here -->' '<!-- to here -->'
