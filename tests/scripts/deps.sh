#!/bin/sh
# deps.sh: tests how cmake/deps.sh installs missing packages, with stand-ins for dpkg-query, apt-get
# and the program that it waits with: nothing is installed.
# shellcheck disable=SC2015 # fail does not return
set -eu
deps=$(realpath "$(dirname "$0")/../../cmake/deps.sh")
. "$(dirname "$0")/work.sh"
cd "$work"
shown="calls said"

mkdir bin
PATH=$work/bin:$PATH
program() { # NAME, its text from standard input
    { echo '#!/bin/sh' && cat; } >"bin/$1"
    chmod +x "bin/$1"
}
program dpkg-query <<'END'
for package; do :; done
case $package in here*) echo 'ii ' ;; removed) echo 'rc ' ;; *) exit 1 ;; esac
END
program dpkg <<'END'
echo "dpkg $*" >>calls
echo 0 >locked
END
program id <<'END'
cat user
END
program sudo <<'END'
exit 1
END
program sleep <<'END'
echo "sleep $*" >>calls
END
# The first calls fail; the file `locked` says how many.
program apt-get <<'END'
echo "$*" >>calls
read -r locked <locked
[ "$locked" -gt 0 ] || exit 0
echo $((locked - 1)) >locked
cat why >&2
exit 100
END
try() { # LOCKED WHY LIST...
    echo "$1" >locked
    echo "$2" >why
    shift 2
    : >calls
    status=0
    "$deps" "$@" >said 2>&1 || status=$?
}
printf 'here1\nmissing1\nremoved\n\nsold sh\n' >one.txt
printf 'here2\nmissing2 no-such-program' >two.txt # and no newline
echo here3 >whole.txt
echo 0 >user

try 0 '' one.txt two.txt whole.txt
[ $status = 0 ] || fail "status $status"
waits='-qq -o DPkg::Lock::Timeout=600 -o Acquire::Retries=3'
printf '%s\n' "$waits update" \
    "$waits install -y --no-install-recommends missing1 removed missing2" >expected
cmp -s calls expected || fail "another call of apt-get than expected"

try 0 '' whole.txt
[ $status = 0 ] && [ ! -s calls ] || fail "nothing is missing, and apt-get is called"

# apt itself does not wait for the lock of its lists.
try 2 'E: Could not get lock /var/lib/apt/lists/lock. It is held by process 7 (apt-get)' one.txt
[ $status = 0 ] || fail "locked twice: status $status"
[ "$(grep -c '^sleep' calls)" = 2 ] && [ "$(grep -c 'update$' calls)" = 3 ] || fail "locked twice"
try 1000 'E: Could not get lock /var/lib/apt/lists/lock' one.txt
[ $status != 0 ] && [ "$(grep -c 'update$' calls)" = 60 ] || fail "locked for good: status $status"

# A server that fails for a moment is asked again, one that goes on failing three times in all.
try 2 'E: Failed to fetch missing1.deb  Connection timed out' one.txt
[ $status = 0 ] && [ "$(grep -c '^sleep' calls)" = 2 ] || fail "failed twice: status $status"
try 1000 'E: Unable to locate package missing1' one.txt
[ $status != 0 ] && [ "$(grep -c 'update$' calls)" = 3 ] || fail "failing for good: status $status"
grep -q 'Unable to locate' said || fail "the error is not shown"

# The packages of an install that was interrupted are configured, which no other failure does; then apt-get works.
! grep -q '^dpkg' calls || fail "dpkg is called though no install was interrupted"
try 1000 "E: dpkg was interrupted, you must manually run 'dpkg --configure -a' to correct the problem. " one.txt
[ $status = 0 ] || fail "an install was interrupted: status $status"
[ "$(grep '^dpkg' calls)" = 'dpkg --configure -a' ] || fail "an install was interrupted, and dpkg is not called once"
[ "$(grep -c 'install' calls)" = 1 ] || fail "the packages are not installed after an interrupted install"

echo 1000 >user
try 0 '' one.txt
[ $status = 1 ] && [ ! -s calls ] || fail "without root: status $status"
grep -q 'sudo apt-get .* install .* missing1 removed$' said || fail "the command to run is not shown"

try 0 '' no-such-list.txt
[ $status != 0 ] || fail "a list that is not there is no error"
echo "packages that are missing are installed, and apt's locks are waited for"
