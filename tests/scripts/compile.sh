#!/bin/bash
# compile.sh ROOT: tests cmake/locked.sh, and the output of cmake/compile.sh on two sources: warnings and
# errors unchanged, the progress, and nothing of CMake's or make's.
set -eu
compile=$1/cmake/compile.sh
. "$(dirname "$0")/work.sh"
cd "$work"

shown=said
has() { grep -q -- "$1" said || fail "no '$1' in"; }
has_not() { ! grep -q -- "$1" said || fail "'$1' in"; }

cat >CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.20)
project(two C)
add_compile_options(-Wall)
add_executable(two one.c two.c)
add_executable(other other.c)
END
echo 'int two(void); int main(void) { return two(); }' >one.c
printf 'int two(void)\n{\n    int unused;\n    return 0;\n}\n' >two.c
echo 'this is no C' >other.c
cmake -S . -B build -G 'Unix Makefiles' >said 2>&1 || fail 'cannot be configured'

# Builds one target and not the others; called by a make that prints its folders.
printf 'all:\n\t@%s build 2 two\n' "$compile" >Makefile
make -w >said 2>&1 || fail 'a program with a warning is not built'
[ -x build/two ] || fail 'no program'
has 'unused variable'
has_not 'Built target'
has_not 'Building C object'
[ "$(grep -c 'Entering directory' said)" -eq 1 ] || fail 'folders that make entered'

# It ends with the status of an error.
status=0
"$compile" build 2 other >said 2>&1 || status=$?
[ "$status" -ne 0 ] || fail 'an error is no failure'
has 'error'

# On a terminal one line moves, cut to the terminal's width, and is erased at the end.
touch one.c two.c
TERM=xterm script -qec "stty cols 24; $compile build 1 two" /dev/null </dev/null >said 2>&1 ||
    fail 'it fails on a terminal'
has 'compiling, [0-9]* %: '
tr '\r' '\n' <said | grep 'compiling' | sed 's/\x1b\[K//' | while IFS= read -r line; do
    [ ${#line} -le 23 ] || fail "a line of ${#line} characters"
done
has_not 'Built target'

# Of two calls in one folder the second waits, says so, and ends with the status of its command.
locked=$1/cmake/locked.sh
"$locked" . sh -c 'echo first begins; sleep 1; echo first ends' >order &
while [ ! -s order ]; do sleep 0.1; done
status=0
"$locked" . sh -c 'echo second; exit 3' >>order 2>said || status=$?
wait
[ "$status" -eq 3 ] || fail "status $status of a command that ends with 3"
has 'waiting for another make'
printf 'first begins\nfirst ends\nsecond\n' | cmp -s - order || fail "two at once: $(xargs <order)"
