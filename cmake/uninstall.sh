#!/bin/sh
# uninstall.sh PREFIX: removes what `make install` put below ${DESTDIR}PREFIX, as its list there says: files, then
# folders that were made for them and are empty.
set -eu
target=${DESTDIR:-}$(realpath -ms "$1")
list=$target/share/mote/installed.txt
[ -e "$list" ] || {
    echo "uninstall: $list is not there, so nothing was installed by \`make install\` with this prefix" >&2
    exit 1
}
LC_ALL=C sort -r "$list" | while IFS= read -r path; do # what is in a folder before the folder
    case $path in
    /* | ../* | */../* | '') echo "uninstall: $list: '$path' is left alone" >&2 ;;
    */) rmdir "$target/$path" 2> /dev/null || true ;;
    *)
        rm -f "$target/$path"
        case $path in *.py) # what Python kept of it
            cache=$target/$(dirname "$path")/__pycache__
            rm -f "$cache/$(basename "$path" .py)".*.pyc
            rmdir "$cache" 2> /dev/null || true
            ;;
        esac
        ;;
    esac
done
