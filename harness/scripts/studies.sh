#!/usr/bin/env bash
# studies.sh TABLE RECORDS WORK [list]: says which studies of TABLE (harness/scripts/studies.tsv) have a stale
# record in RECORDS, why, and what they would cost; runs them one after another, and keeps their small
# files in RECORDS/COMMIT/STUDY. The status is 1 if a study is still stale then, or failed. With `list`,
# nothing is run.
#   ONLY="NAME..."  these studies alone       HOURS=H  starts no part that would end later than in H hours
#   BUSY=1          measures times although other programs run; the record has the load before it
#   JOBS=N          so many parts at a time, where times do not matter
#   PROGRAM=FILE    the program, built from this tree
#
# A study is fresh while the files that it exercises are those of its record (by the hashes that git
# keeps of them), and all of its parts are in it and passed. It stays fresh where C files alone have changed
# and PROGRAM is still the recorded one to the last byte; studies that run programs of tests/ go by the
# files alone. Parts that passed are kept in WORK/STUDY, and are not run again after an interruption, unless
# the sources have changed since.
set -euo pipefail
table=$1 records=$2 work=$3 list=${4:-}
only=${ONLY:-} hours=${HOURS:-} busy=${BUSY:-} jobs=${JOBS:-1} file_of_program=${PROGRAM:-} began=$(date +%s)
# The variables of this call are not those of the studies' own, some of which have the same names.
unset MAKEFLAGS ONLY HOURS BUSY JOBS PROGRAM

fail() {
    echo "record: $1" >&2
    exit "${2:-4}"
}
[ -z "$hours" ] || [[ $hours =~ ^[0-9]+(\.[0-9]+)?$ ]] || fail "HOURS=$hours: give a number of hours, such as 1.5" 2
git rev-parse --verify --quiet HEAD >/dev/null || fail "no git repository here, so no record could name its sources"
if [ -z "$list" ] && [ -n "$(git status --porcelain -uno)" ]; then
    fail "there are changes that are not committed; commit them, so that the record can name its sources"
fi
commit=$(git rev-parse --short=10 HEAD)
program=${file_of_program:+$(git hash-object "$file_of_program" | cut -c 1-16)}
compiled='^(core|baselines|datasets|harness)/.*\.(c|h|cpp|hpp)$'

# The value of a key in a study.json, which has one a line.
value() { # FILE KEY
    sed -nE "s/^ *\"$2\": (\"([^\"]*)\"|([^\",]+)),?$/\2\3/p" "$1"
}
# One hash for the files below some paths, as they are in this tree.
hash_of() { # PATH...
    [ -n "$(git ls-files -- "$@")" ] || fail "$table: $name: there is no file in $*"
    { git ls-files -s -- "$@" && git diff HEAD -- "$@"; } | git hash-object --stdin | cut -c 1-16
}
# The newest record of the study, "" if there is none.
newest() {
    local file date last='' found=''
    for file in "$records"/*/"$name"/study.json; do
        [ -f "$file" ] || continue
        date=$(value "$file" ended)
        if [[ ! $date < $last ]]; then
            last=$date found=$file
        fi
    done
    echo "$found"
}
has_these_sources() { # STUDY.JSON
    [ "$(value "$1" sources_hash)" = "$hash" ] || [ "$(value "$1" same_program)" = "$hash" ]
}
has_this_program() { # STUDY.JSON CHANGED
    [ -n "$program" ] && [ "$(value "$1" program)" = "$program" ] && [[ " $sources" != *" tests"* ]] &&
        ! grep -qvE "$compiled" <<<"$2"
}
# Why the study is stale; nothing if it is fresh.
staleness() {
    local file parts_of old changed
    file=$(newest)
    if [ -z "$file" ]; then
        echo "never recorded"
        return
    fi
    parts_of=$(value "$file" parts_done) old=$(value "$file" commit)
    if ! has_these_sources "$file"; then
        # shellcheck disable=SC2086 # a list of paths
        changed=$(git diff --name-only "$old" -- $sources 2>/dev/null || true)
        if [ -z "$changed" ]; then
            echo "other sources than at $old"
            return
        elif ! has_this_program "$file" "$changed"; then
            echo "$(head -1 <<<"$changed")$(awk 'END { if (NR > 1) printf " and %d more", NR - 1 }' <<<"$changed") changed since $old"
            return
        fi
    fi
    if [ "$(value "$file" failed)" != 0 ]; then
        echo "failed at $old: $(value "$file" failed) of $parts parts"
    elif [ "$parts_of" -lt "$parts" ]; then
        echo "$parts_of of $parts parts recorded, at $old"
    fi
}
parts_done() {
    find "$work/$name" -maxdepth 2 -name .passed 2>/dev/null | wc -l
}
# Reads a line of the table into name, place, minutes, parts, sources, files, command and hash.
next_study() {
    while IFS=$'\t' read -r name place minutes parts sources files command; do
        [[ $name = "" || $name = \#* ]] && continue
        if [[ ! $place =~ ^(alone|beside)$ || ! $minutes =~ ^[0-9]+$ || ! $parts =~ ^[0-9]+$ || -z $command ]]; then
            fail "$table: $name: write NAME, alone or beside, minutes and number of parts, sources, files and command"
        fi
        names="$names $name"
        [ -z "$only" ] || [[ " $only " = *" $name "* ]] || continue
        # shellcheck disable=SC2086 # a list of paths
        hash=$(hash_of $sources) || exit
        return 0
    done
    return 1
}
check_names() {
    local name
    for name in $only; do
        [[ "$names " = *" $name "* ]] || fail "no study $name; there are:$names" 2
    done
}

list_stale() {
    local total=0 count=0 why left
    while next_study; do
        why=$(staleness)
        [ -n "$why" ] || continue
        left=$((minutes * (parts - $(current_parts))))
        total=$((total + left)) count=$((count + 1))
        printf '%-14s %6.1f h  %-7s %s\n' "$name" "$(awk -v m=$left 'BEGIN { print m / 60 }')" "$place" "$why"
    done
    check_names
    if [ $count = 0 ]; then
        echo "nothing is stale"
        return 0
    fi
    echo "$count stale, $(awk -v m=$total 'BEGIN { printf "%.1f", m / 60 }') h"
    return 1
}
# The parts that need not be run again: those in WORK of the same sources.
current_parts() {
    if [ "$(cat "$work/$name/.sources" 2>/dev/null)" = "$hash" ]; then
        parts_done
    else
        echo 0
    fi
}

# Waits up to ten minutes until nothing else runs; "" if something still does.
is_quiet() {
    local tries load
    for tries in $(seq 60); do
        load=$(cut -d ' ' -f 1 /proc/loadavg)
        if awk -v l="$load" 'BEGIN { exit !(l < 0.5) }'; then
            return 0
        fi
        [ "$tries" != 1 ] || echo "record: $name: waiting until nothing else runs (load $load)" >&2
        sleep 10
    done
    return 1
}
is_late() {
    [ -n "$hours" ] && awk -v h="$hours" -v s=$(($(date +%s) - began)) -v m="$minutes" 'BEGIN { exit !(s / 3600 + m / 60 > h) }'
}
run_part() { # PART
    local out=$work/$name/part-$1 status=0 start load
    local log=$out.log # not within OUT, which a command may empty
    [ ! -e "$out/.passed" ] || return 0
    ! is_late || return 75
    if [ "$place" = alone ] && [ -z "$busy" ] && ! is_quiet; then
        fail "$name measures times, and other programs run; end them, or record them with BUSY=1"
    fi
    mkdir -p "$out"
    start=$(date +%s)
    echo "record: $name, part $1 of $parts" >&2
    local polite=
    [ "$place" = alone ] || polite="nice -n 19"
    load=$(cut -d ' ' -f 1 /proc/loadavg)
    OUT=$out PART=$1 $polite sh -c "$command" >"$log" 2>&1 || status=$?
    if [ "$status" -ge 126 ]; then # not found, or ended by a signal
        tail -3 "$log" >&2
        fail "$name was ended (status $status): $log; \`make record\` goes on there"
    fi
    mkdir -p "$out"
    mv "$log" "$out/log.txt"
    echo "$load" >"$out/.load"
    echo $(($(date +%s) - start)) >"$out/.seconds"
    echo "$status" >"$out/.status"
    if [ "$status" = 0 ]; then
        touch "$out/.passed"
    else
        echo "record: $name, part $1: status $status: $out/log.txt" >&2
    fi
}
processor() {
    sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1 | tr -d '"'
}
# Sums the checks of all parts, lines of {check, tried, failed}.
sum_checks() {
    awk -F'\t' '!($1 in tried) { order[++n] = $1 } { tried[$1] += $2; failed[$1] += $3 }
        END { for (i = 1; i <= n; ++i) printf "%s\t%.0f\t%.0f\n", order[i], tried[order[i]], failed[order[i]] }' "$@"
}
# Copies the files of a part that the table names; a pattern does not look into folders that it does not name.
# Figures keep their names, other/file becomes other-file.
keep_files() { # PART FOLDER
    local pattern file name patterns
    read -ra patterns <<<"$files"
    for pattern in "${patterns[@]}"; do
        while read -r file; do
            name=${file#"$1/"} name=${name#figures/}
            cp "$file" "$2/${name//\//-}"
        done < <(compgen -G "$1/$pattern")
    done
}
keep() {
    local folder=$records/$commit/$name part passed failed checks
    rm -rf "$folder.part"
    mkdir -p "$folder.part"
    passed=$(parts_done)
    failed=$(cat "$work/$name"/part-*/.status | awk '$1 != 0 { ++n } END { print n + 0 }')
    for part in $(seq "$parts"); do # of one name the last part's file stays
        keep_files "$work/$name/part-$part" "$folder.part"
    done
    checks=("$work/$name"/part-*/checks.tsv)
    [ ! -f "${checks[0]}" ] || sum_checks "${checks[@]}" >"$folder.part/checks.tsv"
    cat >"$folder.part/study.json" <<JSON
{
  "study": "$name",
  "commit": "$commit",
  "ended": "$(date -u +%Y-%m-%dT%H:%M:%S.%3NZ)",
  "machine": "$(processor), $(nproc) cores, $(uname -sr)",
  "place": "$place",
  "load_before": $(sort -g "$work/$name"/part-*/.load | tail -1),
  "seconds": $(cat "$work/$name"/part-*/.seconds | awk '{ s += $1 } END { print s + 0 }'),
  "parts": $parts,
  "parts_done": $passed,
  "failed": $failed,
  "sources": "$sources",
  "sources_hash": "$hash",
  "program": "$program",
  "command": "${command//\"/\\\"}"
}
JSON
    rm -rf "$folder"
    mv "$folder.part" "$folder"
    echo "$folder: $passed of $parts parts passed, $failed failed"
}
# Parts whose times do not matter run JOBS at a time.
run_parts() {
    local part at_once=1 ended=0
    [ "$place" = alone ] || at_once=$jobs
    for part in $(seq "$parts"); do
        run_part "$part" &
        while [ "$(jobs -rp | wc -l)" -ge "$at_once" ] && [ $ended = 0 ]; do
            wait -n || ended=$?
        done
        [ $ended = 0 ] || break
    done
    while [ -n "$(jobs -p)" ]; do
        wait -n || ended=$?
    done
    case $ended in
    0) ;;
    75) late="$late $name" ;;
    *) exit "$ended" ;;
    esac
}
# In fresh records whose files have changed: that the program of these files is the same.
note_same_program() {
    local file
    while next_study; do
        file=$(newest)
        [ -z "$(staleness)" ] || continue
        has_these_sources "$file" ||
            sed -i -e '/^ *"same_program"/d' -e "s/^\( *\)\"sources_hash\".*/&\n\1\"same_program\": \"$hash\",/" "$file"
    done
}
run_study() {
    [ -n "$(staleness)" ] || return 0
    if [ "$(cat "$work/$name/.sources" 2>/dev/null)" != "$hash" ]; then
        rm -rf "${work:?}/$name"
        mkdir -p "$work/$name"
        echo "$hash" >"$work/$name/.sources"
    fi
    run_parts
    ! compgen -G "$work/$name/part-*/.status" >/dev/null || keep
}

# Parts in the background do not hear Ctrl-C by themselves.
trap 'trap "" TERM; kill 0; exit 130' INT TERM
names='' late='' status=0
if ! list_stale <"$table"; then
    [ -z "$list" ] || exit 1
    names=''
    while next_study <&3; do
        run_study
    done 3<"$table"
    [ -z "$late" ] || echo "record: not finished within $hours h:$late" >&2
    names=''
    list_stale <"$table" || status=1
fi
[ -n "$list" ] || note_same_program <"$table"
exit $status
