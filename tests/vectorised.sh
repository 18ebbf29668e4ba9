#!/bin/sh
# Shows that the hot loop of the particles is vectorised: in each version of mote_potential (one an
# instruction set) the multiplications over several lanes must outnumber those of single numbers.
# Usage: vectorised.sh build/libmote_core.a
set -eu
objdump -d --no-show-raw-insn "$1" 2> /dev/null | awk '
    /^[0-9a-f]+ <.*>:$/ {
        name = substr($2, 2, length($2) - 3)
        inside = name ~ /^mote_potential(\.|$)/ && name !~ /resolver/
        if (inside)
            versions[name] = 1
    }
    inside && /[ \t]v?mulpd[ \t]/ {
        ++lanes[name]
        width[name] = /%zmm/ ? 8 : /%ymm/ ? 4 : 2
    }
    inside && /[ \t]v?mulsd[ \t]/ { ++single[name] }
    END {
        for (name in versions) {
            ++count
            printf "%-40s %d multiplications of %d lanes, %d of one\n", name, lanes[name],
                width[name], single[name]
            if (lanes[name] <= single[name])
                bad = 1
        }
        exit bad || !count
    }'
