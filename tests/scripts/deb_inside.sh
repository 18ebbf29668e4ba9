#!/bin/sh
# deb_inside.sh before|use|develop|remove: what deb.sh does on the bare machine, in this order.
set -eu
fail() { echo "deb_inside.sh: $*" >&2; exit 1; }
# Every file of ours on the machine; "remote" is none.
files() {
    find / -xdev -path /mote -prune -o -path /proc -prune -o -path /tmp -prune -o -path /var/cache/apt -prune -o -print |
        grep -E '(^|[^a-z])(lib)?mote' | sort
}
case $1 in
before)
    files > before || true
    ;;
use)
    [ ! -e /mote/CMakeLists.txt ] || fail "the sources are here"
    mote --version
    mote run ww --frames 1-100 --method certified --method fcl-aabb --out ww > table
    cat table
    for row in certified fcl-aabb; do grep -q "^$row  *-  *[0-9]" table || fail "no row $row"; done
    bench/bench.sh mote quick quick > bench.log 2>&1 || { tail -20 bench.log; fail "the quick bench"; }
    [ -s quick/report.html ] && [ -s quick/figures/fig3.svg ] || fail "no report or no figures"
    tail -25 bench.log
    man=$(zcat /usr/share/man/man1/mote.1.gz | grep -c '^\.B mote ')
    [ "$man" -ge 10 ] || fail "the manual names $man commands"
    # The module finds its library.
    /usr/bin/python3 - <<'PYTHON'
import mote
import numpy
corners = numpy.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
faces = numpy.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], dtype=numpy.uint32)
mesh = mote.Mesh(corners, faces)
print("import mote:", mote.__file__, mote.library_version)
PYTHON
    ;;
develop)
    apt-get install -y --no-install-recommends gcc libc6-dev pkg-config libode-dev > log
    # shellcheck disable=SC2046
    cc -std=c17 track.c $(pkg-config --cflags --libs mote) -o track
    ./track > out
    seq 8 | awk '{ printf "frame %d: distance %.9f\n", $1, 3 - 0.3 * $1 }' | cmp - out
    # shellcheck disable=SC2046
    cc -std=c17 track.c $(pkg-config --cflags mote) $(pkg-config --static --libs mote | sed 's/-lmote/-l:libmote.a/') \
        -o static
    ./static | cmp - out
    sh -e 'engine commands' > table
    cat table
    for row in engine certified fcl-aabb; do grep -q "^$row  *-  *[0-9]" table || fail "no row $row"; done
    ;;
remove)
    apt-get purge -y mote libmote0 libmote-dev python3-mote > log
    files > after || true
    diff before after || fail "removing the packages leaves something"
    echo "removed, and nothing is left"
    ;;
esac
