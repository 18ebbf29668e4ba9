#!/bin/sh
# all_methods.sh MOTE: checks that the program has every method that the sources define. The build
# leaves out a baseline whose library is missing. That is right for a user, but wrong on a machine
# with everything that packages.txt lists.
set -eu
mote=$(realpath "$1")
. "$(dirname "$0")/work.sh"
cd "$(dirname "$0")/../.."
# A method's name is its identifier with hyphens. Coal has no package that packages.txt could name.
grep -rhE '^MOTE_METHOD\(' core baselines | grep -v '(coal_' | sed 's/^MOTE_METHOD(\([a-z0-9_]*\)).*/\1/' | tr _ - |
    sort >"$work/defined"
"$mote" list methods | sed -n 's/^\([a-z0-9-]*\): .*/\1/p' | sort >"$work/listed"
[ -s "$work/defined" ] || fail "no method is defined"
if grep -vxFf "$work/listed" "$work/defined" >"$work/missing"; then
    echo "all_methods.sh: left out, since packages.txt does not name their library:" \
        "$(paste -sd ' ' "$work/missing")" >&2
    exit 1
fi
echo "all $(wc -l <"$work/defined") methods are in the program"
