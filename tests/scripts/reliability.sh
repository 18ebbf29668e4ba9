#!/usr/bin/env bash
# make reliability: runs the studies one after another, prints a table of what was tried, how often,
# and what failed, and writes OUT/reliability.json, a list of {check, tried, failed}.
#   reliability.sh BUILD BUILD_ASAN BUILD_FUZZ BUILD_TSAN quick|full OUT [plant]
# plant: adds one wrong answer, one lost row and one leak, which must be reported, and nothing else.
# Full takes hours: JOBS=2 fuzzes two targets at a time, ONLY="kills fuzz" runs some of the studies.
set -u
build=$1 asan=$2 fuzz=$3 tsan=$4 profile=$5 out=$6 plant=${7:-}
only=${ONLY:-certify skins streamed impacts metamorphic soak oracle answers threads kills stops faults fuzz}
case $profile in
quick) queries=20000 impacts=5000 pairs=190000 soak="--cases 40" seconds=10 kills=10 runs=56 ;;
*) queries=1000000 impacts=100000 pairs=11400000 soak="--cases 11500" seconds=3600 kills=200 runs=100 ;;
esac
rm -rf "$out"
mkdir -p "$out"
checks=$out/checks.tsv
: >"$checks"

add() { # CHECK TRIED FAILED
    printf '%s\t%s\t%s\n' "$1" "$2" "$3" >>"$checks"
}
# Runs a command with its output in a log.
log() { # NAME COMMAND...
    local name=$1
    shift
    echo "reliability: $name" >&2
    "$@" >"$out/$name.log" 2>&1
}
# A check that is a program: tried is a number in its output, failed is its status.
program() { # CHECK NAME PATTERN COMMAND...
    local check=$1 name=$2 pattern=$3 failed=0
    shift 3
    log "$name" "$@" || failed=1
    add "$check" "$(cat "$out/$name".* | grep -aoE "$pattern" | grep -oE '[0-9]+' | sed -n 1p)" \
        $failed
    return $failed
}

fuzz() {
    local failed=0
    log fuzz tests/scripts/fuzz.sh "$fuzz" $seconds "${JOBS:-1}" "$out/fuzz" || failed=1
    awk -F'\t' '{ printf "fuzz: %s\t%d\t%d\n", $1, $3, $4 }' "$out/fuzz/fuzz.tsv" >>"$checks"
    [ $failed -eq 0 ] || tail -30 "$out/fuzz.log" >&2
    return $failed
}
# Runs programs one after another and sums what each tried: a number in its output, or 1 without a
# pattern. Output goes to OUT/NAME.log.
programs() { # CHECK NAME PATTERN PROGRAM...
    local check=$1 name=$2 pattern=$3 tried=0 failed=0 program count
    shift 3
    : >"$out/$name.log"
    for program in "$@"; do
        log one $program || failed=$((failed + 1))
        count=$(grep -aoE "$pattern" "$out/one.log" | grep -oE '[0-9]+' | tail -1)
        [ -z "$pattern" ] && count=1
        tried=$((tried + ${count:-0}))
        cat "$out/one.log" >>"$out/$name.log"
    done
    rm -f "$out/one.log"
    add "$check" $tried $failed
    [ $failed -eq 0 ]
}
# Eight runs under ThreadSanitizer, or those with THREADS threads; that of gcc 12 does not start with wide
# address randomisation.
threads() {
    local fixed= k runs=()
    ! setarch -R true 2>"$out/threads.log" || fixed="setarch -R"
    for k in ${THREADS:-1 2 3 4 5 6 7 8}; do
        runs+=("$fixed $tsan/tests/answers --check tests/answers.txt --threads $k")
    done
    TSAN_OPTIONS=halt_on_error=1 programs \
        "one hash over all answers: under ThreadSanitizer, 1 to 8 threads" threads '' \
        "${runs[@]}"
}
study() { # NAME
    case $1 in
    certify)
        log certify "$build/tests/certify" --queries $queries --checks "$checks" \
            --out "$out/certify.json" ;;
    skins)
        log skins "$build/tests/skins" --queries $queries --checks "$checks" \
            --out "$out/skins.json" ;;
    streamed)
        log streamed "$build/tests/streamed" --queries $queries --checks "$checks" \
            --out "$out/streamed.json" ;;
    impacts)
        log impacts "$build/tests/impacts" --queries $impacts --checks "$checks" \
            --out "$out/impacts.json" ;;
    metamorphic) log metamorphic "$build/tests/metamorphic" --queries $queries --checks "$checks" ;;
    soak) # shellcheck disable=SC2086 # two words
        log soak "$build/tests/soak" $soak --checks "$checks" --out "$out" ${plant:+--plant} ;;
    oracle)
        program "triangle pairs against rational arithmetic" oracle '"pairs": *[0-9]+' \
            "$build/tests/oracle" --pairs $pairs --out "$out/oracle.json" ;;
    answers) log answers tests/scripts/determinism.sh "$build" $runs "${JOBS:-1}" "$checks" ;;
    kills)
        program "sweeps killed at random: a cell lost, changed or twice" kills \
            '[0-9]+ kills within' "$build/tests/kills" "$out/kills" $kills 1 ${plant:+plant} ;;
    threads) threads ;;
    stops)
        programs "runs stopped, disks full, clocks set, children that crash or hang: tests" stops \
            '[0-9]+ test\(s\) run' "$build/tests/test_durability" "$build/tests/test_clock" \
            "$build/tests/test_child" ;;
    faults)
        ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=1 programs \
            "allocations, writes, syncs and renames that fail: no error, or a leak" faults \
            '[0-9]+ calls failed' "${plant:+env MOTE_PLANT_LEAK=1 }$asan/tests/test_faults" \
            "$asan/tests/test_allocations" ;;
    fuzz) fuzz ;;
    *)
        echo "reliability: no study $1" >&2
        exit 2
        ;;
    esac
}
failures() {
    awk -F'\t' '$3 > 0' "$checks" | wc -l
}
for name in $only; do
    before=$(failures)
    study "$name" && continue
    tail -3 "$out/$name.log" >&2
    [ "$(failures)" -gt "$before" ] || add "$name: ended badly" 1 1
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
# Every check must have tried something, and only planted failures may occur.
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
sweeps killed at random: a cell lost, changed or twice
allocations, writes, syncs and renames that fail: no error, or a leak"
if [ "$failed" = "$expected" ]; then
    echo "reliability: what was planted was found, and nothing else"
else
    echo "reliability: planted and found differ" >&2
    exit 1
fi
