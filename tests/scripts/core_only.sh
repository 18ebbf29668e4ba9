#!/bin/bash
# core_only.sh: builds the library alone with each C compiler found, in C only, installs it, and links
# the program of docs/extending.md and tests/studies/core_only.c with it, by hand, and by pkg-config
# for cc -static. It may need no other library, and all compilers must give the same bits.
set -euo pipefail
tests=$(realpath "$(dirname "$0")")
. "$(dirname "$0")/work.sh"
cd "$work"
"$tests/documented.sh" track.c > track.c

check()
{
    local compiler=$1 build=$work/$1 root=$work/$1-root
    # Without a C++ compiler, to see that none is needed.
    CXX=/nonexistent cmake -S "$tests/../.." -B "$build" -DMOTE_CORE_ONLY=ON -DMOTE_WERROR=ON \
        -DCMAKE_C_COMPILER="$compiler" > log 2>&1 || { cat log; fail "$compiler: configuration"; }
    cmake --build "$build" -j "$(nproc)" > log 2>&1 || { cat log; fail "$compiler: build"; }
    cmake --install "$build" --prefix "$root" > log
    local library
    library=$(dirname "$(find "$root" -name libmote.a)")
    objdump -p "$library/libmote.so" > needed || fail "$compiler: no shared library"
    if grep NEEDED needed | grep -vE 'lib(m|c)\.|ld-linux|libc\.musl'; then
        fail "$compiler: the library needs more than the C library"
    fi
    local program way
    for program in track core_only; do
        local source=$work/track.c
        [ $program = track ] || source=$tests/../studies/core_only.c
        "$compiler" -std=c17 -Wall -Wextra -Werror -I"$root/include" "$source" \
            "$library/libmote.a" -lm -o static
        "$compiler" -std=c17 -Wall -Wextra -Werror -I"$root/include" "$source" \
            -L"$library" -lmote -lm -Wl,-rpath,"$library" -o shared
        grep -q 'NEEDED *libmote' <<< "$(objdump -p shared)" || fail "$compiler: not shared"
        # It is fully static, including the C library.
        # shellcheck disable=SC2046 # a list of words
        "$compiler" -std=c17 -static "$source" $(PKG_CONFIG_PATH="$library/pkgconfig" pkg-config \
            --static --cflags --libs mote) -o whole
        ! grep NEEDED <<< "$(objdump -p whole)" || fail "$compiler: cc -static links what is shared"
        for way in static shared whole; do
            ./$way > "$program-$compiler-$way" || { cat "$program-$compiler-$way"; fail "$compiler $way"; }
            [ -e "$program-first" ] || cp "$program-$compiler-$way" "$program-first"
            cmp "$program-first" "$program-$compiler-$way" || fail "$compiler $way: other answers"
        done
    done
    echo "$compiler: $("$compiler" --version | sed 1q), the library alone, static and shared, same answers"
}

grep -q . track.c
checked=0
for compiler in gcc clang musl-gcc; do
    if command -v "$compiler" > log; then
        check "$compiler"
        checked=$((checked + 1))
    else
        echo "left out: $compiler is not installed"
    fi
done
[ "$checked" -gt 0 ] || fail "no compiler"
grep -q "convex parts" core_only-first || fail "a method without n was not refused"
[ "$(grep -c "^certified: . " core_only-first)" = 5 ] || fail "certified gave no answers"
cat core_only-first
