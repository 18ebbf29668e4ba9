#!/bin/sh
# install.sh BUILD PREFIX: installs a build below ${DESTDIR}PREFIX. share/mote/installed.txt lists what was
# put there, files and the folders that were made for them, for uninstall.sh. An earlier installation in
# the same place is removed first, so that nothing of it is left over.
set -eu
build=$1
prefix=$(realpath -ms "$2")
target=${DESTDIR:-}$prefix
list=$target/share/mote/installed.txt
stage=$(mktemp -d)
trap 'rm -rf "$stage"' EXIT
DESTDIR=$stage cmake --install "$build" --prefix "$prefix" > "$stage/log"
if [ -e "$list" ]; then "$(dirname "$0")/uninstall.sh" "$prefix"; fi
mkdir -p "$stage$prefix/share/mote"
# Folders end with a slash; those that were there already belong to others.
(cd "$stage$prefix" && find . ! -type d && find . -type d -printf '%p/\n') | sed 's|^\./||; /^$/d' | LC_ALL=C sort \
    > "$stage/all"
while IFS= read -r path; do
    case $path in */) [ ! -d "$target/$path" ] || continue ;; esac
    printf '%s\n' "$path"
done < "$stage/all" > "$stage/list"
echo share/mote/installed.txt >> "$stage/list"
cmake --install "$build" --prefix "$prefix"
cp "$stage/list" "$list"
# The system's list of libraries, where it looks into this folder: programs then find libmote at once.
if [ -z "${DESTDIR:-}" ] && ldconfig -N -v 2> /dev/null | grep -q "^$prefix/lib:"; then
    ldconfig || echo "install: run ldconfig as root, so that programs find the library" >&2
fi
