#!/bin/bash
# deb.sh FOLDER: the packages in FOLDER (make deb), checked by lintian, then installed on a bare Debian 12 by the
# line of the Containerfile, used without the sources (the program, a quick bench, a program in C, a plug-in,
# Python), and removed, after which nothing may be left.
set -euo pipefail
packages=$(realpath "$1")
tests=$(realpath "$(dirname "$0")")
source=$(realpath "$tests/../..")
. "$(dirname "$0")/work.sh"

lintian --allow-root --fail-on error "$packages"/*.deb || fail "lintian finds errors"
for package in mote libmote0 libmote-dev python3-mote; do
    ls "$packages/$package"_*.deb > "$work/found" || fail "no package $package"
    dpkg-deb -f "$packages/$package"_*.deb Depends > "$work/depends"
    grep -qE 'lib[a-z]+[-0-9.]* \((>=|=) ' "$work/depends" || fail "$package depends on no library"
done

# The container is made by the same lines: see the last stage of the Containerfile.
install=$(sed -n '/^FROM/h; /^RUN/H; ${ g; s/.*\nRUN //; p }' "$source/Containerfile")
[ -n "$install" ] && grep -q '^RUN .*make deb$' "$source/Containerfile" || fail "no such lines in the Containerfile"

mkdir "$work/bring"
cp "$packages"/*.deb "$work/bring"
cp "$tests/deb_inside.sh" "$tests"/../library/skin*.c "$work/bring"
for name in track.c engine.c touch.json 'engine commands'; do
    "$tests/documented.sh" "$name" > "$work/bring/$name"
done
mkdir "$work/bring/bench"
cp "$source"/harness/scripts/{bench,measure,engines}.sh "$work/bring/bench"
"$tests/bare.sh" --bring "$work/bring" './deb_inside.sh before' "$install" './deb_inside.sh use' \
    './deb_inside.sh develop' './deb_inside.sh remove'
