#!/usr/bin/env bash
# make fuzz: each fuzz target for some seconds, several at a time, from the committed corpus.
#   [TARGET=NAME] fuzz.sh BUILD_FUZZ SECONDS JOBS OUT [SEED]
# TARGET: this one alone.
# SEED: of the inputs tried (1); 0: another one each time.
# The targets are those that were built. OUT/fuzz.tsv: a line a target, {target, CPU seconds, executions, findings};
# OUT/checks.tsv: the same for a record (make record). The findings are in OUT as crash-*, oom-* or timeout-*.
# Exit status 1 where something was found or nothing was tried.
# A slow machine tries fewer inputs but fails none: 120 s for one input are a hang anywhere.
set -u
build=$1 seconds=$2 jobs=$3 out=$4 seed=${5:-1}
built=$(find "$build/tests" -maxdepth 1 -type f -executable -name 'fuzz_*' -printf '%f\n' | sed 's/^fuzz_//' | sort)
targets=${TARGET:-$built}
if [ -n "${TARGET:-}" ] && ! grep -qxF "$TARGET" <<<"$built"; then
    echo "fuzz: there is no target $TARGET; give one of ${built//$'\n'/ }" >&2
    exit 2
fi
mkdir -p "$out"
rm -f "$out"/*.tsv "$out"/*.log "$out"/*.found

fuzz_one() { # TARGET
    mkdir -p "$out/corpus/$1"
    local found=0 tried cpu TIMEFORMAT='%U %S'
    cpu=$({ time "$build/tests/fuzz_$1" -seed="$seed" -max_total_time="$seconds" -timeout=120 -rss_limit_mb=4096 \
        -print_final_stats=1 -artifact_prefix="$out/$1-" "$out/corpus/$1" \
        "tests/corpus/fuzz_$1" >"$out/$1.log" 2>&1 || touch "$out/$1.found"; } 2>&1 |
        awk '{ print $1 + $2 }')
    [ ! -e "$out/$1.found" ] || found=1
    tried=$(grep -aoE 'number_of_executed_units: *[0-9]+' "$out/$1.log" | grep -oE '[0-9]+')
    printf '%s\t%d\t%d\t%d\n' "$1" "${cpu%.*}" "${tried:-0}" $found >"$out/$1.tsv"
    [ $found -eq 0 ] || tail -30 "$out/$1.log" >&2
}

for target in $targets; do
    fuzz_one "$target" &
    while [ "$(jobs -rp | wc -l)" -ge "$jobs" ]; do
        wait -n
    done
done
wait
for target in $targets; do
    cat "$out/$target.tsv"
done >"$out/fuzz.tsv"
awk -F'\t' '{ printf "fuzz: %s, inputs\t%d\t%d\n", $1, $3, $4 }' "$out/fuzz.tsv" >"$out/checks.tsv"
awk -F'\t' '{ printf "fuzz_%s: %d CPU s, %d inputs, %d findings\n", $1, $2, $3, $4 }
    $3 < 1 || $4 > 0 { bad = 1 } END { exit bad || NR < 1 || NR < wanted }' \
    wanted="$(wc -w <<<"$targets")" "$out/fuzz.tsv"
