#!/bin/sh
# author.sh MOTE [NAME...]: places body 1 of the built-in scenarios anew, so that the gaps between
# the bodies are as listed here (FRAME:GAP, of L; below 0: pushed on after first contact). Needed
# only when a letter or a field has changed: `mote check NAME` says whether a scenario still is what
# it claims.
set -eu
mote=$1
shift
names=${*:-ww tt mv}
here=$(cd "$(dirname "$0")" && pwd)

# approach EVERY GAPS...: a key pose every so many frames.
approach() {
    every=$1
    shift
    "$mote" approach "$here/scenarios/$name.json" --every "$every" \
        --gaps "$(echo "$*" | tr ' ' ',')" -o "$here/scenarios/$name.json"
}

for name in $names; do
    case $name in
    ww)
        approach 12 1:0.55,300:0.45,650:0.25,850:0.12,930:0.08,1000:-0.012,1070:0.05,1140:0.003 \
            1210:0.08,1280:-0.012,1350:0.07,1420:-0.004,1490:0.05,1560:-0.015,1630:0.08 \
            1700:0.001,1770:0.07,1840:-0.01,1910:0.05,1984:0.06
        ;;
    tt)
        approach 12 1:0.4,100:0.3,180:0.1,230:-0.03,275:0.07,320:-0.03,365:0.1,410:0.003,455:0.09 \
            500:-0.035,545:0.07,600:0.06
        ;;
    mv)
        approach 12 1:0.4,100:0.3,190:0.09,240:-0.012,280:0.05,320:0.003,360:0.07,400:-0.014 \
            440:0.05,480:0.006,520:0.07,560:-0.012,600:0.05
        ;;
    *)
        echo "author.sh: $name has no gaps here; known are ww tt mv" >&2
        exit 2
        ;;
    esac
done
