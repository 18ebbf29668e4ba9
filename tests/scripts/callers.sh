#!/bin/sh
# Checks that every function declared in a header of harness/ or baselines/ has a caller in the
# program: a function that only tests call belongs to the tests.
# Usage: callers.sh SOURCE
set -eu
export LC_ALL=C
. "$(dirname "$0")/work.sh"
cd "$1"

# Exceptions: a test makes documents from columns and compares them; front_time gives tests access to
# a part of the fronts.
allowed='mote_columns_markdown mote_columns_schema mote_front_time'

find harness baselines -name '*.h' -o -name '*.hpp' | xargs grep -hvE 'static inline' |
    grep -oE '\bmote_[a-z0-9_]+\(' | tr -d '(' | sort -u > "$work/declared"
# A name that occurs at most twice in all sources is declared and defined, but not called.
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
