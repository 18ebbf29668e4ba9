#!/bin/sh
# Every function that a header of harness/ or baselines/ declares has a caller in the program: what
# only tests call belongs to the tests.
# Usage: callers.sh SOURCE
set -eu
export LC_ALL=C
cd "$1"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Columns become documents in a test, which compares them; front_time is what tests see of a part
# of the fronts.
allowed='mote_columns_markdown mote_columns_schema mote_front_time'

find harness baselines -name '*.h' -o -name '*.hpp' | xargs grep -hvE 'static inline' |
    grep -oE '\bmote_[a-z0-9_]+\(' | tr -d '(' | sort -u > "$work/declared"
# A name that stands once in all sources is defined and nothing else.
find harness baselines core/*/*.h -name '*.c' -o -name '*.cpp' -o -name '*.h' -o -name '*.hpp' |
    xargs cat | sed 's,/\*[^*]*\*/,,g' | grep -oE '\bmote_[a-z0-9_]+\b' | sort | uniq -c |
    awk '$1 <= 2 {print $2}' | sort > "$work/rare"
failed=0
for name in $(comm -12 "$work/declared" "$work/rare"); do
    case " $allowed " in *" $name "*) continue ;; esac
    echo "$name: declared, and not called in harness or baselines"
    failed=1
done
for name in $allowed; do
    grep -qx "$name" "$work/declared" || { echo "$name: allowed, but not declared"; failed=1; }
done
exit $failed
