#!/bin/sh
# deps.sh FILE: installs the Debian packages that FILE lists and that are missing, when it may
# (root, or sudo without a password); else prints the one command to run and exits 1. A line is
# PACKAGE, or PACKAGE PROGRAM: then the package is not needed where the program is found.
set -eu
missing=
while read -r package program || [ -n "$package" ]; do
    [ -n "$package" ] || continue
    if [ -n "$program" ] && command -v "$program" >/dev/null; then
        continue
    fi
    state=$(dpkg-query -W -f='${db:Status-Abbrev}' "$package" 2>/dev/null || true)
    case $state in
    ii*) ;;
    *) missing="$missing $package" ;;
    esac
done <"$1"
[ -n "$missing" ] || exit 0
if [ "$(id -u)" = 0 ]; then
    run=
elif sudo -n true 2>/dev/null; then
    run='sudo -n'
else
    echo "Packages are missing. Run, then try again:" >&2
    echo "    sudo apt-get update && sudo apt-get install -y --no-install-recommends$missing" >&2
    exit 1
fi
export DEBIAN_FRONTEND=noninteractive
$run apt-get update -q
# shellcheck disable=SC2086
$run env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $missing
