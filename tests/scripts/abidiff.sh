#!/bin/bash
# abidiff.sh BASE: the library of revision BASE beside this one's, both built alone (MOTE_CORE_ONLY) with debug
# information, by abidiff. Fails where a program that was linked with BASE's might fail. Reports what changed.
set -euo pipefail
base=${1:?abidiff.sh BASE: name a revision}
source=$(realpath "$(dirname "$0")/../..")
. "$(dirname "$0")/work.sh"
cd "$work"
git -C "$source" archive --prefix=base/ "$base" | tar -x
build() { # SOURCE BUILD
    cmake -S "$1" -B "$2" -DMOTE_CORE_ONLY=ON -DCMAKE_BUILD_TYPE=Debug -DCMAKE_C_FLAGS=-g > log &&
        cmake --build "$2" -j "$(nproc)" --target mote_shared > log 2>&1 || { cat log; exit 1; }
}
build base before
build "$source" now
status=0
abidiff --headers-dir1 before/include --headers-dir2 now/include before/libmote.so now/libmote.so || status=$?
# Of its bits, 4 says that something changed, 8 that this breaks programs; the others are errors.
[ $((status & ~4)) -eq 0 ] || { echo "abidiff.sh: not compatible with $base (abidiff: $status)" >&2; exit 1; }
echo "programs linked with the library of $base run with this one"
