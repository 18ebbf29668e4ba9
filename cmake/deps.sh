#!/bin/sh
# deps.sh FILE...: installs the Debian packages that the files list and that are missing, when it may
# (root, or sudo without a password); else prints the one command to run and exits 1. A line is
# PACKAGE, or PACKAGE PROGRAM: then the package is not needed where the program is found.
set -eu
lists=$(cat "$@")
missing=
while read -r package program; do
    [ -n "$package" ] || continue
    if [ -n "$program" ] && command -v "$program" >/dev/null; then
        continue
    fi
    state=$(dpkg-query -W -f='${db:Status-Abbrev}' "$package" 2>/dev/null || true)
    case $state in
    ii*) ;;
    *) missing="$missing $package" ;;
    esac
done <<LISTS
$lists
LISTS
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
errors=$(mktemp)
trap 'rm -f "$errors"' EXIT

locked() {
    grep -q 'Could not get lock' "$errors"
}

# apt ARGUMENT...: apt-get, waiting while another process uses it. By itself it waits for the
# lock of dpkg only; for the lock of its lists and archives it is called again, for ten minutes.
# It does not name the servers that it asks, which would stand in the logs of studies otherwise.
apt() {
    tries=60
    until $run env DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=600 \
        -o Acquire::Retries=3 "$@" 2>"$errors"; do
        cat "$errors" >&2
        tries=$((tries - 1))
        [ $tries -gt 0 ] && locked || return 1
        sleep 10
    done
    cat "$errors" >&2
}

# A server that is out of reach for a moment, or lists that changed between both calls, need not
# end a build: both are made again, three times in all.
install() {
    # shellcheck disable=SC2086
    apt update && apt install -y --no-install-recommends $missing
}
echo "Installing$missing" >&2
for wait in 10 30; do
    install && exit 0
    ! locked || exit 1
    # An install that was killed leaves packages unpacked, and apt-get installs nothing until they are configured.
    if grep -q 'dpkg was interrupted' "$errors"; then
        echo "Configuring the packages of an install that was interrupted" >&2
        $run env DEBIAN_FRONTEND=noninteractive dpkg --configure -a >&2
    fi
    echo "Packages were not installed; trying again in $wait s." >&2
    sleep $wait
done
install
