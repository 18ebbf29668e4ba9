# put_marked TEXT PAGE BEGINS ENDS: replaces what stands in PAGE between its lines BEGINS and ENDS by the file TEXT, with
# the commit, the day and the machine of MANIFEST, a run's manifest.json. Sourced by what writes tables into documents.
value() { sed -nE "s/^ *\"$1\": (\"([^\"]*)\"|([a-z0-9]+)),?$/\2\3/p" "$MANIFEST" | head -n 1; }

put_marked() {
    for mark in "$3" "$4"; do
        grep -qxF -e "$mark" "$2" || { echo "$(basename "$0"): $2 has no line '$mark'" >&2; exit 4; }
    done
    dirty=
    [ "$(value dirty)" = false ] || dirty=' with changes'
    {
        echo
        echo "Measured on $(value started | cut -c 1-10) with commit $(value commit | cut -c 1-8)$dirty, $(value processor)."
        echo
        cat "$1"
        echo
    } >"$1.marked"
    awk -v text="$1.marked" -v begins="$3" -v ends="$4" '
        $0 == ends { skipping = 0 }
        !skipping
        $0 == begins { while ((getline line < text) > 0) print line; skipping = 1 }' "$2" >"$1.page"
    cat "$1.page" >"$2"
    rm -f "$1.marked" "$1.page"
}
