#!/usr/bin/env bash
# Builds tests/studies/answers.c, and what it needs, with each compiler and optimisation, and once with
# sanitizers, and runs each build with 1 to 8 threads: every run must give the answers of
# tests/answers.txt. Usage: determinism.sh BUILD [RUNS [JOBS [CHECKS]]], from the root; BUILD holds
# the table of methods. RUNS is the total: those beyond eight of each build (56) are shared among the
# optimised ones; 1: one build answers a few, to see that it can be built. CHECKS: a file from which
# make reliability makes its table. BUILDS, of the environment: these alone, such as "gcc-O2 asan".
set -eu
build=$1 runs=${2:-56} jobs=${3:-2} checks=${4:-}
. "$(dirname "$0")/work.sh"
flags="-std=c17 -D_POSIX_C_SOURCE=200809L -DMOTE_IN_TREE -ffp-contract=off -fno-math-errno -fno-trapping-math -I.
    -include $work/config.h"
printf '#define MOTE_SOURCE_DIR "%s"\n' "$PWD" >"$work/config.h"
# Of baselines, only FCL's broad phase is linked.
libraries="$build/libmote_baselines.a -lfcl -lccd -lgsl -lgslcblas -ljansson -lassimp -lz -lHACD
    -lmeshoptimizer -ldl -lpthread -lm"
cache=$(command -v ccache || true)

sources=$(ls core/*/*.c datasets/*.c harness/{base,engine,gltf,mesh,scene,sequence}/*.c |
    grep -v -e core/certificate/plain.c -e core/base/version.c)
for name in child confine crew spawn stop; do
    sources="$sources harness/process/$name.c"
done
sources="$sources tests/studies/answers.c $build/core_registry.c"

# Prints nothing when it goes well.
make_program() { # NAME COMPILER FLAGS
    local cxx=${2/clang/clang++}
    cxx=${cxx/gcc/g++}
    mkdir -p "$work/$1"
    # shellcheck disable=SC2086 # lists of words
    printf '%s\n' $sources | xargs -P "$jobs" -I {} sh -c \
        "$cache $2 $(echo $flags) $3 -c {} -o $work/$1/\$(echo {} | tr / _).o" &&
        for part in core/parts/*.cpp; do
            $cache $cxx -std=c++17 -I. $3 -c "$part" -o "$work/$1/$(basename "$part").o" || return
        done &&
        $cxx $3 "$work/$1"/*.o -o "$work/$1/answers" $libraries
}

tried=0
failed=0
check() { # PROGRAM WORDS...
    tried=$((tried + 1))
    "$@" >"$work/log" 2>&1 && return
    cat "$work/log"
    echo "other answers: $*"
    failed=$((failed + 1))
}

try_build() { # NAME COMPILER FLAGS MORE_RUNS
    [ -z "${BUILDS:-}" ] || [[ " $BUILDS " = *" $1 "* ]] || return 0
    command -v "$2" >"$work/log" || { echo "left out: $2 is not installed"; return; }
    if ! make_program "$1" "$2" "$3"; then
        echo "not built: $2 $3"
        failed=$((failed + 1))
        return
    fi
    # shellcheck disable=SC2086 # a word, or none
    for threads in $all_threads; do
        check "$work/$1/answers" $few --check tests/answers.txt --threads "$threads"
    done
    for ((run = 0; run < $4; ++run)); do
        check "$work/$1/answers" --check tests/answers.txt
    done
    rm -r "${work:?}/$1"
    echo "answered: $2 $3"
}

if [ "$runs" -eq 1 ]; then
    all_threads=2
    few=--few
    try_build gcc-O0 gcc -O0 0
    [ $tried -gt 0 ] && [ $failed -eq 0 ]
    exit
fi
few=""
all_threads="1 2 3 4 5 6 7 8"
more=$((runs > 56 ? (runs - 56 + 3) / 4 : 0))
for compiler in gcc clang; do
    try_build $compiler-O0 $compiler -O0 0
    try_build $compiler-O2 $compiler -O2 $more
    try_build $compiler-O3 $compiler -O3 $more
done
try_build asan gcc "-O1 -g -fsanitize=address,undefined -fno-sanitize-recover=undefined" 0
echo "$tried runs, $failed with other answers"
[ -z "$checks" ] ||
    printf 'one hash over all answers: builds, threads and runs\t%d\t%d\n' $tried $failed >>"$checks"
[ $tried -gt 0 ] && [ $failed -eq 0 ]
