#!/bin/sh
# relink.sh BUILD COUNT OUT [PROGRAM [FIRST]]: links a program of a build folder (mote by default; tests/NAME
# for a test) COUNT times with its object files in random orders, into OUT/PROGRAM-NN, numbered from FIRST (1)
# on. The position of functions in memory changes their times by about a per cent, so two builds can be compared
# only over several such orders (mote race A B, each a folder). A number stands for the same order in every
# build; a file that one of them lacks does not change the order of the others. Existing programs newer than the
# build are kept, and those of other numbers removed: they may be of an older build.
set -eu
build=$1
count=$2
program=${4:-mote}
first=${5:-1}
name=$(basename "$program")
mkdir -p "$3"
out=$(cd "$3" && pwd)
cd "$build"
built=$PWD/$program

# Lists are words, one a line: a path may have blanks.
newline='
'
IFS=$newline
set -f

# The words of a command as CMake writes it, quoted where they need it.
words_in() {
    IFS=' '
    eval "set -- $1"
    printf '%s\n' "$@"
}

# Prints the command that links the file $1 of the target $3 in the folder $2: from CMake's makefiles,
# which run it in that folder, or from Ninja, which runs it in the current one.
command_of() {
    if [ -f "$2/CMakeFiles/$3.dir/link.txt" ]; then
        head -1 "$2/CMakeFiles/$3.dir/link.txt"
    else
        ninja -t commands "$1" | tail -1 | sed 's/^: && //; s/ && :$//; s/ && / /g'
    fi
}

# The object files in a command, relative to the folder in which the program is linked, so that a
# blank in the path of the build is in none of them; $2: the folder that the command $1 runs in.
objects_in() {
    words_in "$1" | grep '\.o$' | while read -r object; do realpath -s --relative-to="$from" "$2/$object"; done
}

# Objects of the program and of our libraries, without repetition: some are in both.
place=$(dirname "$program")
from=.
[ ! -f "$place/CMakeFiles/$name.dir/link.txt" ] || from=$place
whole=$(command_of "$program" "$place" "$name")
link=$(words_in "$whole" | grep -vx -e '.*libmote_[a-z]*\.a' -e '.*\.o')
objects=$({
    objects_in "$whole" "$from"
    words_in "$whole" | sed -n 's|.*lib\(mote_[a-z]*\)\.a$|\1|p' | sort -u |
        while read -r library; do objects_in "$(command_of "lib$library.a" . "$library")" .; done
} | sort -u)
cd "$from"

# $1: the number of the order. The place of an object comes from a hash of this number and of its name.
shuffled() {
    printf '%s\n' "$objects" | awk -v number="$1" '
        BEGIN { for (i = 1; i < 256; ++i) code[sprintf("%c", i)] = i }
        {
            hash = 1000 * number
            # Squares of numbers below this prime are exact.
            for (i = 1; i <= length($0); ++i) hash = (hash * hash + code[substr($0, i, 1)] + number) % 67108859
            printf "%08d\t%s\n", hash, $0
        }' | sort | cut -f 2
}

# The options of the command stay the same; -o is replaced.
relink() {
    set -- "$1" "$(printf '%s\n' "$link" | awk '
        skip { skip = 0; next } $0 == "-o" { skip = 1; next } { print }')" "$(shuffled "$1")"
    # shellcheck disable=SC2046,SC2086
    set -- "$1" $(printf '%s\n' "$2" | sed -n '1p') $3 $(printf '%s\n' "$2" | sed '1d')
    number=$1
    shift
    "$@" -o "$out/.linking-$number"
    mv "$out/.linking-$number" "$out/$name-$number"
}

is_kept() {
    [ -n "$(find "$out/$name-$1" -newer "$built" 2>/dev/null)" ]
}

numbers=$(seq -f %02g "$first" "$((first + count - 1))")
# shellcheck disable=SC2086 # a word for each number
find "$out" -maxdepth 1 -name "$name-[0-9]*" | grep -vxF "$(printf "$out/$name-%s\n" $numbers)" |
    while read -r other; do rm "$other"; done
for number in $numbers; do
    is_kept "$number" || relink "$number"
done
