#!/bin/sh
# race_study.sh RACE_STUDY RECORDS WORK: make perf-study finds the races that it has stored, and counts them in its
# table. In each record of the gate below RECORDS, power.md is the table of races.csv. What is raced here answers at once.
set -eu
study=$1 records=$2 work=$3
fail() { echo "race_study: $*" >&2; exit 1; }
rm -rf "$work"
mkdir -p "$work/programs/a" "$work/programs/b"
cat >"$work/programs/a/00" <<'RACER'
#!/bin/sh
times=20000
for _ in $(seq 199); do times=$times,20000; done
printf 'mote-race\t1\n'
while read -r request _ _ last _; do
    case $request in
    cell) printf 'ok\t0\t1\t%s\n' "$last" ;;
    *) printf 'ok\t1\t-\t%s\n' "$times" ;;
    esac
done
RACER
chmod +x "$work/programs/a/00"
cp "$work/programs/a/00" "$work/programs/b/01"
"$study" run "$work/programs" "$work" 1 0 >"$work/said" || fail "status $?: $(cat "$work/said")"
line='(idle|compiler|busy),none,0,1,0,0,2,0,0,1\.00000,1\.00000,1\.00000,[0-9]+,[0-9.]+,[0-9.]+'
[ "$(grep -cxE "$line" "$work/races.csv")" = 2 ] || fail "two lines are expected in $(cat "$work/races.csv")"

"$study" run "$work/programs" "$work" 2 1 'idle:4' 2>"$work/said" && fail 'ONLY=idle:4 is not refused'
grep -q '^mote: ONLY="idle:4": .*such as "idle:2 compiler:5"' "$work/said" || fail "$(cat "$work/said")"
"$study" run "$work/programs" "$work/only" 0 1 'compiler:5' >"$work/said" || fail "status $?: $(cat "$work/said")"
[ "$(cut -d , -f 2-4 "$work/only/races.csv")" = "$(printf '%s\n' plant,per_cent,number 'certified query,5,1' 'particle sweep,5,1' 'clock path,5,1')" ] || fail "ONLY=compiler:5: $(cat "$work/only/races.csv")"
grep -q '^MOTE_PLANT=clock:1000 ' "$work/only/racers/b/00" || fail "5 % of a frame of 20 us: $(cat "$work/only/racers/b/00")"
for side in a/00 b/01; do
    grep -qF " exec '$work/programs/$side' " "$work/only/racers/${side%/*}/00" || fail "programs/$side is not raced"
done

# Beside other tests the machine may have been busy, and then the race would be repeated.
sed -i '2s/^[a-z]*/idle/; 3s/^[a-z]*/compiler/' "$work/races.csv"
[ -z "$("$study" run "$work/programs" "$work" 1 0)" ] || fail "a race that has its line was raced again"
"$study" table "$work/races.csv" "$work/power" >"$work/power.md"
for place in idle 'beside a compiler'; do
    grep -qF "| unchanged, $place | 1 | 0 of 1 (0 to " "$work/power.md" || fail "$place: $(cat "$work/power.md")"
done

for record in "$records"/*/gate; do
    "$study" table "$record/races.csv" "$work/power" | cmp - "$record/power.md"
done
