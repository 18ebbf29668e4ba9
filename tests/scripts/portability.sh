#!/bin/sh
# Builds tests/unit/core/test_portability.c with each compiler, optimisation and instruction set and runs
# it: every build must give the hashes that the test holds. Usage: portability.sh SOURCE_DIR [few]
# Skips and names instruction sets that this machine cannot run, and compilers that it lacks. few: four
# unlike builds, as make test-long does; make determinism tries them all.
set -eu
. "$(dirname "$0")/work.sh"
cd "$1"
few=${2:-}
flags="-std=c17 -D_POSIX_C_SOURCE=200809L -ffp-contract=off -fno-math-errno -fno-trapping-math -I."
sources="tests/unit/core/test_portability.c tests/support/test_main.c tests/support/folder.c \
    harness/base/file.c harness/base/memory.c"
for name in status mesh_create mesh_ring field_kinds field_evaluate field_sum csrbf modes body deform lazy \
    potential site start far_cache particles triangle triangle_scale refine \
    certificate_query certificate_apart certificate_create certificate_build certificate_split certificate_box certificate_fitted \
    certificate_fitted_build certificate_deform certificate_leaf certificate_row certificate_pair \
    certificate_hulls certificate_triangles certificate_search leaf_order sample_split pool stream_boxes \
    stream_descend stream_faces stream_leaf stream_pair stream_query stream_search stream_traverse \
    stream_tree levels descent coherence pairs \
    tracker_create tracker_query tracker_search \
    skin skin_create skin_fit skin_frame skin_bounds morph morph_fit; do
    sources="$sources $(ls core/*/$name.c)"
done

wanted()
{
    case $few:$1 in
    few:"gcc -O0" | few:"gcc -O3 -march=x86-64-v3" | few:"clang -O3" | few:"clang -O3 -march=x86-64-v4") true ;;
    few:*) false ;;
    esac
}

runs_here()
{
    printf 'int main(void) { return 0; }' > "$work/probe.c"
    "$1" -march="$2" "$work/probe.c" -o "$work/probe" 2> "$work/log" || return 1
    case $2 in
    x86-64) true ;;
    x86-64-v3) grep -qw avx2 /proc/cpuinfo && grep -qw fma /proc/cpuinfo ;;
    x86-64-v4) grep -qw avx512vl /proc/cpuinfo && grep -qw avx512dq /proc/cpuinfo ;;
    esac
}

checked=0
failed=0
check()
{
    wanted "$1 $2" || return 0
    program="$work/test_portability"
    # shellcheck disable=SC2086 # lists of words
    if "$1" $flags $2 $sources -lcmocka -lpthread -lm -o "$program" && "$program" > "$work/log" 2>&1; then
        echo "same bits: $1 $2"
    else
        cat "$work/log"
        echo "other bits: $1 $2"
        failed=$((failed + 1))
    fi
    checked=$((checked + 1))
}

for compiler in gcc clang; do
    if ! command -v "$compiler" > "$work/log"; then
        echo "left out: $compiler is not installed"
        continue
    fi
    for level in -O0 -O2 -O3; do
        check "$compiler" "$level"
    done
    case $(uname -m) in
    x86_64)
        for isa in x86-64-v3 x86-64-v4; do
            if runs_here "$compiler" "$isa"; then
                check "$compiler" "-O0 -march=$isa"
                check "$compiler" "-O3 -march=$isa"
            else
                echo "left out: $compiler -march=$isa does not run here"
            fi
        done
        ;;
    esac
done
echo "$checked builds, $failed with other bits"
[ "$checked" -gt 0 ] && [ "$failed" -eq 0 ]
