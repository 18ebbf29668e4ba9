#!/bin/sh
# Checks that the hot loops are vectorised: in each version (one an instruction set) multiplications
# of several lanes must outnumber those of single numbers.
# Usage: vectorised.sh build/libmote_core.a
set -eu
objdump -d --no-show-raw-insn "$1" 2> /dev/null | awk '
    BEGIN {
        wanted = split("mote_potential project_block deform_block convert_all mote_cert_row_boxes move_group " \
            "project_points mote_cert_near_pairs csrbf_estimate skin_convex_boxes skin_convex_project " \
            "skin_leaf_boxes skin_leaf_project morph_convex_boxes morph_convex_project " \
            "morph_leaf_boxes morph_leaf_project convert face_rows turn_leaf mote_stream_distances", loops, " ")
        for (k in loops)
            missing[loops[k]] = 1
    }
    /^[0-9a-f]+ <.*>:$/ {
        name = substr($2, 2, length($2) - 3)
        loop = name
        sub(/[.].*/, "", loop)
        inside = name !~ /resolver/ && loop in missing
        if (inside) {
            versions[name] = 1
            missing[loop] = 0
        }
    }
    inside && /[ \t]v?mulp[sd][ \t]/ {
        ++lanes[name]
        width[name] = (/%zmm/ ? 8 : /%ymm/ ? 4 : 2) * (/mulps/ ? 2 : 1)
    }
    inside && /[ \t]v?muls[sd][ \t]/ { ++single[name] }
    END {
        for (name in versions) {
            printf "%-40s %d multiplications of %d lanes, %d of one\n", name, lanes[name],
                width[name], single[name]
            if (lanes[name] <= single[name])
                bad = 1
        }
        for (k = 1; k <= wanted; ++k) {
            if (missing[loops[k]]) {
                printf "%-40s is not there\n", loops[k]
                bad = 1
            }
        }
        exit bad
    }'
