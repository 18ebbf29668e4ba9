#!/bin/sh
# compile.sh FOLDER JOBS [TARGET...]: builds what CMake has configured. Shows how far it is: one line
# that moves on a terminal, a line each ten seconds elsewhere. Warnings and errors stand as they are.
set -eu
folder=$1
jobs=$2
shift 2
[ $# -eq 0 ] || set -- --target "$@"

# MAKE_TERMOUT: CMake would colour its lines for the terminal that is not its own.
build() {
    status=0
    unset MAKE_TERMOUT MAKE_TERMERR
    # The jobs are ours to count, and make names no folders.
    MAKEFLAGS=--no-print-directory cmake --build "$folder" -j "$jobs" "$@" 2>&1 || status=$?
    echo "compile.sh: status $status"
}

# Characters of a terminal's line, but the last.
columns=$(stty size 2>/dev/null </dev/tty | cut -d ' ' -f 2) || columns=
[ "${columns:-0}" -gt 1 ] || columns=80
columns=$((columns - 1))

tell() {
    if [ -t 2 ]; then
        printf '\r\033[K%.*s' "$columns" "$1" >&2
    elif [ "$(date +%s)" -ge "$next" ]; then
        echo "$1" >&2
        next=$(($(date +%s) + 10))
    fi
}

clear_line() {
    [ ! -t 2 ] || printf '\r\033[K' >&2
}

build "$@" | {
    next=$(($(date +%s) + 10))
    status=1
    while IFS= read -r line; do
        case $line in
        'compile.sh: status '*) status=${line##* } ;;
        '['*'%] Building '*' object '*)
            file=${line##*.dir/}
            percent=${line%%\%*}
            tell "compiling, ${percent##*[\[ ]} %: ${file%.o}"
            ;;
        '['*'%] '* | 'Consolidate compiler generated'* | 'Scanning dependencies'*) ;;
        *)
            clear_line
            printf '%s\n' "$line" >&2
            ;;
        esac
    done
    clear_line
    exit "$status"
}
