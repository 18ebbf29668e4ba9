#!/usr/bin/env bash
# bare.sh [--bring FOLDER] COMMAND...: runs each command in a fresh clone of HEAD on a bare Debian 12, which
# holds nothing but git, make and this machine's apt configuration. With --bring there is no clone, and the
# commands run in a copy of FOLDER. Ends with the status of the first command that fails. Needs root (or
# sudo without a password), mmdebstrap and 10 GB of disk.
#
# The bare root is kept as a tarball in ${XDG_CACHE_HOME:-~/.cache}/mote and rebuilt when a list of
# packages, the apt configuration or this script changes. Each run unpacks it into a folder of its
# own there and removes that folder at its end, also when interrupted; the next run removes what a
# killed one left behind. Everything is mounted in a namespace that ends with the run, and the root
# has a /dev of its own: nothing that happens to the root can affect this machine.
set -euo pipefail
shopt -s nullglob

# From the caller's environment: warnings are errors in CI; apt may need a proxy.
passed=(CI TERM http_proxy https_proxy ftp_proxy no_proxy HTTP_PROXY HTTPS_PROXY FTP_PROXY NO_PROXY)
fail() {
    echo "bare.sh: $*" >&2
    exit 1
}

# Inside the namespace: mounts what a running system has, then runs the commands.
inside() { # ROOT COMMAND...
    local root=$1 name start environment=(HOME=/root
        PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin)
    shift
    for name in "${passed[@]}"; do
        [ -z "${!name:-}" ] || environment+=("$name=${!name}")
    done
    mount -t proc proc "$root/proc"
    mount -t sysfs -o ro sysfs "$root/sys"
    mount -t tmpfs -o mode=1777 tmpfs "$root/tmp"
    mount -t tmpfs -o mode=755 tmpfs "$root/dev"
    cp -a /dev/{null,zero,full,random,urandom,tty} "$root/dev"
    mkdir "$root"/dev/{pts,shm}
    mount -t devpts -o newinstance,ptmxmode=666 devpts "$root/dev/pts"
    chmod 1777 "$root/dev/shm"
    ln -s pts/ptmx "$root/dev/ptmx"
    ln -s /proc/self/fd "$root/dev/fd"
    for name in stdin:0 stdout:1 stderr:2; do
        ln -s "/proc/self/fd/${name#*:}" "$root/dev/${name%:*}"
    done
    for name in "$@"; do
        echo "== bare: $name"
        start=$SECONDS
        chroot "$root" env -i "${environment[@]}" sh -c "cd /mote && $name"
        echo "== bare: $name took $((SECONDS - start)) s"
    done
}
if [ "${1:-}" = --inside ]; then
    shift
    inside "$@"
    exit
fi

[ $# -gt 0 ] || { echo "usage: bare.sh [--bring FOLDER] COMMAND..." >&2; exit 2; }
if [ "$(id -u)" != 0 ]; then
    sudo -n true 2> /dev/null || fail "a root is made by root: run this as root"
    exec sudo -n --preserve-env="$(IFS=, && echo "${passed[*]}")" "$0" "$@"
fi
self=$(realpath "$0")
source=$(git -C "$(dirname "$self")" rev-parse --show-toplevel)
brought=
if [ "$1" = --bring ]; then
    brought=$(realpath "$2")
    shift 2
fi
[ -n "$brought" ] || [ -z "$(git -C "$source" status --porcelain)" ] ||
    echo "bare.sh: HEAD is tested, without the changes that are not committed" >&2

# Runs a command with mounts and processes of its own: all end with it, and it ends with us. As a
# background job it lets us act on a signal at once; as a group of its own it does not ignore
# Ctrl-C, as a plain background job would.
child=
apart() {
    set -m
    unshare --mount --propagation private --pid --fork --kill-child --mount-proc "$@" < /dev/null &
    child=$!
    set +m
    local status=0
    wait "$child" || status=$?
    child=
    return $status
}

# Removes a folder unless something is mounted below it, which should not happen.
remove() { # FOLDER
    if grep -qF " ${1// /\\040}/" /proc/self/mountinfo; then
        fail "something is mounted below $1, which is left as it is"
    fi
    rm -rf --one-file-system "$1"
}

# A run that uses a folder holds its lock, and so do all its processes.
finish() {
    trap '' INT TERM HUP
    if [ -n "$child" ]; then
        kill -KILL -- "-$child"
        wait "$child" 2> /dev/null || true
    fi
    exec 8>&- 9>&-
    if [ -n "$work" ]; then
        flock -w 60 "$work" true || fail "processes in $work do not end"
        remove "$work"
    fi
}
work=
trap finish EXIT
trap 'exit 130' INT
trap 'exit 143' TERM HUP

cache=${XDG_CACHE_HOME:-$HOME/.cache}/mote
mkdir -p "$cache"
cache=$(realpath "$cache")
exec 8> "$cache/lock"
flock 8
for old in "$cache"/run.*; do
    ! flock -n "$old" true || remove "$old"
done
work=$(mktemp -d "$cache/run.XXXXXX")
exec 9< "$work"
flock 9

# Keys named in the configuration are often stored elsewhere.
keys=$({ find -L /etc/apt -type f \( -name '*.list' -o -name '*.sources' -o -name '*.conf' \) \
    -exec cat {} + | grep -oE '/[^] ,;"]+\.(gpg|asc|pem|crt)' || true; } | sort -u)
# shellcheck disable=SC2016 # the hook expands it
copy_apt='cp -rLT /etc/apt "$1/etc/apt"
for key in $keys; do
    [ ! -f "$key" ] || cp -L --parents "$key" "$1"
done'
key=$(cd "$source" && find -L /etc/apt packages.txt cmake/packages-*.txt "$self" -type f \
    -exec cat {} + | sha256sum | cut -c 1-16)
root=$cache/root-$key.tar
if [ ! -e "$root" ]; then
    echo "bare.sh: making $root"
    export keys TMPDIR=$work
    apart mmdebstrap --quiet --mode=root --variant=minbase --include=git,make,ca-certificates \
        --format=tar --setup-hook="$copy_apt" bookworm "$work/root.tar" -
    rm -f "$cache"/root-*.tar
    mv "$work/root.tar" "$root"
fi
exec 7< "$root" 8>&-

mkdir "$work/debian"
tar -xp --numeric-owner -C "$work/debian" <&7
exec 7<&-
cp -L /etc/resolv.conf /etc/hosts "$work/debian/etc"
if [ -n "$brought" ]; then
    cp -r "$brought" "$work/debian/mote"
else
    git clone --quiet --no-hardlinks "$source" "$work/debian/mote"
fi
apart "$self" --inside "$work/debian" "$@"
