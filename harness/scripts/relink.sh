#!/bin/sh
# relink.sh BUILD COUNT OUT: links the program of a build folder COUNT times with its object files in
# random orders, into OUT/mote-NN. Where functions lie in memory changes their times by about a per
# cent, so that two builds can only be compared over several such orders (mote race A B, each a folder).
# What is there and newer than the build is kept.
set -eu
build=$1
count=$2
mkdir -p "$3"
out=$(cd "$3" && pwd)
cd "$build"

# The command that makes a file: from CMake's makefiles, or from Ninja.
command_of() {
    if [ -f "CMakeFiles/$2.dir/link.txt" ]; then
        head -1 "CMakeFiles/$2.dir/link.txt"
    else
        ninja -t commands "$1" | tail -1
    fi
}

libraries="mote_harness mote_baselines mote_datasets mote_core"
link=$(command_of mote mote | tr ' ' '\n' | grep -vx -e ':' -e '&&' -e '.*libmote_[a-z]*\.a')
objects=$(for library in $libraries; do
    command_of "lib$library.a" "$library" | tr ' ' '\n' | grep '\.o$'
done)

# $1: a seed. The order depends on nothing else.
shuffled() {
    printf '%s\n' "$objects" | awk -v seed="$1" 'BEGIN { srand(seed) } { print rand() "\t" $0 }' |
        sort | cut -f 2
}

# The program's own object and options stay where they are; -o is replaced.
relink() {
    set -- "$1" "$(printf '%s\n' "$link" | awk '
        skip { skip = 0; next } $0 == "-o" { skip = 1; next } { print }')" "$(shuffled "$1")"
    # shellcheck disable=SC2086
    set -- "$1" $(printf '%s\n' "$2" | sed -n '1p') $3 $(printf '%s\n' "$2" | sed '1d')
    number=$(printf '%02d' "$1")
    shift
    "$@" -o "$out/.linking-$number"
    mv "$out/.linking-$number" "$out/mote-$number"
}

is_kept() {
    [ -f "$out/mote-$1" ] && [ "$out/mote-$1" -nt mote ]
}

for seed in $(seq "$count"); do
    is_kept "$(printf '%02d' "$seed")" || relink "$seed"
done
