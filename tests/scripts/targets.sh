#!/bin/sh
# Which tests targets of make run: coverage all, or those of TESTS; test and test-long each test in one of both,
# and test-bare both.
# Usage: targets.sh SOURCE
set -eu
unset TESTS OUT MAKEFLAGS MFLAGS MAKELEVEL
cd "$1"
fail() { echo "targets: $*" >&2; exit 1; }

options() { # TARGET: what it gives to ctest, a line each time
    make -n "$1" | sed -n 's/.* ctest .* -j [0-9]* *//p'
}
counted() { # [TESTS]: the last argument of coverage.sh, with its quotes
    make -n coverage ${1:+"TESTS=$1"} | sed -n '$s/.* //p'
}

[ "$(options test)" = "$(printf -- '-LE long\n-LE long')" ] || fail "test: $(options test)"
[ "$(options test-long)" = "$(printf -- '-L long\n-L long')" ] || fail "test-long: $(options test-long)"
make -n test-bare | grep -q "'make test' 'make test-long'" || fail "test-bare leaves out some tests"
[ "$(counted)" = "''" ] || fail "coverage: $(counted)"
[ "$(counted 'mesh|lazy')" = "'mesh|lazy'" ] || fail "coverage with TESTS: $(counted 'mesh|lazy')"
