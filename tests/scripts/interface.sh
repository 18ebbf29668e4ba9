#!/bin/bash
# interface.sh BUILD: libmote keeps what tests/interface.txt promises; and what would break it is found
# when it is planted in a copy of the headers and of the library.
set -euo pipefail
build=$(realpath "$1")
gate=$(realpath "$(dirname "$0")")/interface.py
. "$(dirname "$0")/work.sh"
cd "$work"

/usr/bin/python3 "$gate" "$build"

# plant HEADER EXPRESSION: the installed headers with one edit by sed, which must change something.
plant() {
    rm -rf planted
    mkdir planted
    cp -r "$build/include" planted
    ln -s "$build/libmote.so" planted
    sed -i -E "$2" "planted/include/mote/$1"
    ! cmp -s "$build/include/mote/$1" "planted/include/mote/$1" || fail "nothing planted in $1"
}
refused() { # TEXT: the gate fails and says so
    ! /usr/bin/python3 "$gate" planted > said 2>&1 || { cat said; fail "not found: $1"; }
    grep -qF -- "$1" said || { cat said; fail "not said: $1"; }
}
plant mesh.h '/^void mote_mesh_destroy\(/d'
refused "function mote_mesh_destroy is gone"
grep -q 'make interface-accept' said || fail "the message does not say how to renew the list"
plant mesh.h 's/^(void mote_mesh_destroy\()[^)]*\)/\1const mote_mesh *mesh, int how)/'
refused "function mote_mesh_destroy was: "
plant vec3.h 's/^( *)double x, y, z;/\1double x, y, z, w;/'
refused "struct mote_vec3 was: 24 bytes; now: 32 bytes"
plant vec3.h 's/^( *)double x, y, z;/\1double x, z, y;/'
refused "member mote_vec3.y was: at 8, double; now: at 16, double"
plant status.h 's/MOTE_EINVAL,/MOTE_EPLANTED, MOTE_EINVAL,/'
refused "value MOTE_EINVAL was: 1; now: 2"
plant status.h 's/^(const char \*mote_error_text\(void\);)/\1 int mote_planted(void);/'
refused "in a public header, but not in libmote.so: mote_planted"
# A variable that the document of promises does not name.
mkdir -p unnamed/tests/scripts unnamed/docs
cp "$gate" unnamed/tests/scripts
cp "$(dirname "$gate")/../interface.txt" unnamed/tests
sed 's/`mote_impact_methods`//' "$(dirname "$gate")/../../docs/compatibility.md" > unnamed/docs/compatibility.md
! /usr/bin/python3 unnamed/tests/scripts/interface.py "$build" > said 2>&1 || { cat said; fail "an unnamed variable is not found"; }
grep -q 'exports variables that compatibility.md does not name: mote_impact_methods;' said || { cat said; fail "not said: mote_impact_methods"; }
# An addition breaks nothing, and is named.
plant status.h 's/^(const char \*mote_error_text\(void\);)/\1 static inline int mote_planted(void) { return 0; }/'
/usr/bin/python3 "$gate" planted > said 2>&1 || { cat said; fail "an addition is refused"; }
grep -q 'not in interface.txt yet.*inline mote_planted' said || { cat said; fail "an addition is not named"; }
echo "a function that is gone, parameters, members, values and what is not exported are found"
