#!/usr/bin/env bash
# make reliability: what was tried, how often, what failed. Runs the studies one after another,
# prints a table and writes OUT/reliability.json, a list of {check, tried, failed}.
#   reliability.sh BUILD BUILD_ASAN BUILD_FUZZ quick|full OUT [plant]
# plant: one wrong answer, one lost row and one leak, which must be reported, and nothing else.
set -u
build=$1 asan=$2 fuzz=$3 profile=$4 out=$5 plant=${6:-}
case $profile in
quick) queries=20000 soak="--cases 40" seconds=10 kills=10 ;;
*) queries=1000000 soak="--cases 11500" seconds=3600 kills=200 ;;
esac
rm -rf "$out"
mkdir -p "$out"
checks=$out/checks.tsv
: >"$checks"

add() { # CHECK TRIED FAILED
    printf '%s\t%s\t%s\n' "$1" "$2" "$3" >>"$checks"
}
# Runs a command, output into a log; a status other than 0 without a line of its own is a failure.
log() { # NAME COMMAND...
    local name=$1
    shift
    echo "reliability: $name" >&2
    "$@" >"$out/$name.log" 2>&1
}
# A check that is a program: tried is a number found in its log, failed is its status.
program() { # CHECK NAME PATTERN COMMAND...
    local check=$1 name=$2 pattern=$3 failed=0
    shift 3
    log "$name" "$@" || failed=1
    add "$check" "$(grep -oE "$pattern" "$out/$name.log" | grep -oE '[0-9]+' | head -1 || true)" $failed
}

log certify "$build/tests/certify" --queries "$queries" --checks "$checks" --out "$out/certify.json" ||
    tail -3 "$out/certify.log" >&2
log metamorphic "$build/tests/metamorphic" --queries "$queries" --checks "$checks" ||
    tail -3 "$out/metamorphic.log" >&2
# shellcheck disable=SC2086 # soak holds two words
log soak "$build/tests/soak" $soak --checks "$checks" --out "$out" ${plant:+--plant} ||
    tail -3 "$out/soak.log" >&2
program "triangle pairs against rational arithmetic" oracle '[0-9]+ pairs' \
    "$build/tests/oracle" --pairs 190000 --stride 0 --out "$out/oracle.json"
program "sweeps killed at random: a cell lost, changed or twice" kills '[0-9]+ kills within' \
    "$build/tests/kills" "$out/kills" $kills 1 ${plant:+plant}
program "allocations, writes, syncs and renames that fail: no error, or a leak" faults '[0-9]+ calls failed' \
    env ${plant:+MOTE_PLANT_LEAK=1} ASAN_OPTIONS=detect_leaks=1 "$asan/tests/test_faults"
for target in scenario mesh options cell; do
    mkdir -p "$out/fuzz/$target"
    program "fuzz: $target" "fuzz-$target" 'number_of_executed_units: *[0-9]+' \
        "$fuzz/tests/fuzz_$target" -max_total_time=$seconds -timeout=30 -print_final_stats=1 \
        -artifact_prefix="$out/fuzz/" "$out/fuzz/$target" "tests/corpus/fuzz_$target"
done

awk -F'\t' 'BEGIN { print "[" }
    { printf "%s  {\"check\": \"%s\", \"tried\": %d, \"failed\": %d}", (NR > 1 ? ",\n" : ""), $1, $2, $3 }
    END { print "\n]" }' "$checks" >"$out/reliability.json"
{
    echo "| check | tried | failed |"
    echo "| --- | ---: | ---: |"
    awk -F'\t' '{ printf "| %s | %d | %d |\n", $1, $2, $3 }' "$checks"
    echo
    echo "$(date -u +%Y-%m-%d), commit $(git rev-parse --short HEAD 2>/dev/null || echo unknown), $profile."
} >"$out/reliability.md"
cat "$out/reliability.md"
# Nothing may be tried in vain, and nothing may fail but what was planted.
if awk -F'\t' '$2 < 1 { bad = 1 } END { exit !bad }' "$checks"; then
    echo "reliability: a check tried nothing" >&2
    exit 1
fi
failed=$(awk -F'\t' '$3 > 0 { print $1 }' "$checks")
if [ -z "$plant" ]; then
    [ -z "$failed" ]
    exit
fi
expected="random scenarios: certified beyond 1e-12 L of the truth
random scenarios: crashes, hangs, answers below the truth
sweeps killed at random: a cell lost, changed or twice
allocations, writes, syncs and renames that fail: no error, or a leak"
if [ "$failed" = "$expected" ]; then
    echo "reliability: what was planted was found, and nothing else"
else
    echo "reliability: planted and found differ" >&2
    exit 1
fi
