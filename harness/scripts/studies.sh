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
# keeps of them, or by a comparison with its commit; texts, *.md, and comments of C files and shell scripts
# are left out), and all of its parts are in it and passed. It stays fresh where C files alone have changed
# and PROGRAM is still the recorded one to the last byte; studies that run programs of tests/ go by the files
# alone. The record is written after each part, and parts that passed are not run again after an
# interruption, unless the sources have changed since: those in WORK/STUDY, or, where WORK has fewer (on
# another machine, say), those of the newest record.
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
no_texts=':!*.md'
declare -A lists # of sources, by @NAME
in_c='\.(c|h|cpp|hpp)$'
compiled="^(core|baselines|datasets|harness)/.*$in_c"

# The value of a key in a study.json, which has one a line.
value() { # FILE KEY
    local line
    while read -r line; do
        if [[ $line = "\"$2\": "* ]]; then
            line=${line#*: } line=${line%,} line=${line#\"}
            echo "${line%\"}"
        fi
    done <"$1"
}
# One hash for the files below some paths, as they are in this tree; texts are no sources.
hash_of() { # PATH...
    local listed hash
    listed=$(git ls-files -s -- "$@" "$no_texts")
    [ -n "$listed" ] || fail "$table: $name: there is no file in $*"
    hash=$({ echo "$listed" && git diff HEAD -- "$@" "$no_texts"; } | git hash-object --stdin)
    echo "${hash:0:16}"
}
# The newest record of the study, "" if there is none.
newest() {
    local files=("$records"/*/"$name"/study.json)
    [ -f "${files[0]}" ] || return 0
    awk -F'"' '$2 == "ended" && $4 >= last { last = $4; found = FILENAME } END { print found }' "${files[@]}"
}
has_these_sources() { # STUDY.JSON
    [ "$(value "$1" sources_hash)" = "$hash" ] || [ "$(value "$1" same_program)" = "$hash" ]
}
has_this_program() { # STUDY.JSON CHANGED
    [ -n "$program" ] && [ "$(value "$1" program)" = "$program" ] && [[ " $sources" != *" tests"* ]] &&
        ! grep -qvE "$compiled" <<<"$2"
}
# What is read from standard input without its comments; fails for a FILE that is neither C nor a shell script.
code() { # FILE
    local first
    if [[ $1 =~ $in_c ]]; then
        gcc -fpreprocessed -dD -E -P -x c++ -
    elif [[ $1 = *.sh ]]; then # its first line names the shell; the rest as a function, as the shell prints it
        read -r first
        echo "$first"
        { echo 'script() {' && cat && printf '\n}\ndeclare -f script\n'; } | bash
    else
        return 1
    fi
}
# Many records were made while a file was the same: what was compared once is known by its hashes.
compared=$(mktemp -d)
trap 'rm -rf "$compared"' EXIT
has_same_code() { # FILE OLD_HASH HASH, all zeros where the file is not as in the index
    local old new known=$compared/$2-$3
    [[ $3 =~ ^0+$ ]] || ! [ -e "$known" ] || return "$(<"$known")"
    old=$(git cat-file blob "$2" | code "$1") && new=$(code "$1" <"$1") && [ "$old" = "$new" ]
    local status=$?
    echo $status >"$known"
    return $status
} 2>/dev/null
# Those of some files whose code has changed since a commit.
with_other_code() { # the lines of git diff --raw on standard input
    local old new status file
    while read -r _ _ old new status file; do
        [ "$status" = M ] && has_same_code "$file" "$old" "$new" || echo "${file##*$'\t'}"
    done
}
# What the record exercised and is not so any more; nothing if all of it is.
change_since() { # STUDY.JSON
    local old changed
    ! has_these_sources "$1" || return 0
    old=$(value "$1" same_commit)
    [ -n "$old" ] || old=$(value "$1" commit)
    # shellcheck disable=SC2086 # a list of paths
    if ! changed=$(git diff --raw --no-abbrev "$old" -- $sources "$no_texts" 2>/dev/null); then
        echo "other sources than at $old"
        return
    fi
    [ -z "$changed" ] || changed=$(with_other_code <<<"$changed")
    if [ -n "$changed" ] && ! has_this_program "$1" "$changed"; then
        echo "$(head -1 <<<"$changed")$(awk 'END { if (NR > 1) printf " and %d more", NR - 1 }' <<<"$changed") changed since $old"
    fi
}
# Why the study is stale; nothing if it is fresh.
staleness() {
    local file parts_of failed change
    file=$(newest)
    if [ -z "$file" ]; then
        echo "never recorded"
        return
    fi
    change=$(change_since "$file") parts_of=$(value "$file" parts_done) failed=$(value "$file" failed)
    if [ -n "$change" ]; then
        echo "$change"
    elif [ "$failed" != 0 ]; then
        echo "failed at $(value "$file" commit): $failed of $parts parts"
    elif [ "$parts_of" -lt "$parts" ]; then
        echo "$parts_of of $parts parts recorded, at $(value "$file" commit)"
    fi
}
# The parts that passed, by number.
parts_passed() {
    find "$work/$name" -mindepth 2 -maxdepth 2 -path '*/part-*/.passed' 2>/dev/null | sed -E 's/.*part-([0-9]+).*/\1/' | sort -n
}
# Those of a record that goes for these sources; none where a part failed, whose checks are in its sums.
recorded_parts() { # STUDY.JSON
    if [ -n "$1" ] && [ "$(value "$1" failed)" = 0 ] && [ -z "$(change_since "$1")" ]; then
        value "$1" parts_passed | tr ' ' '\n'
    fi
}
# Sources with the paths of each @NAME in its place.
paths_of() { # SOURCES
    local word words paths=''
    read -ra words <<<"$1"
    for word in "${words[@]}"; do
        if [[ $word = @* ]]; then
            [ -n "${lists[$word]:-}" ] || fail "$table: $name: there is no line $word"
            word=${lists[$word]}
        fi
        paths="$paths $word"
    done
    echo "${paths# }"
}
# Reads a line of the table into name, place, minutes, parts, sources, files, command and hash.
next_study() {
    while IFS=$'\t' read -r name place minutes parts sources files command; do
        [[ $name = "" || $name = \#* ]] && continue
        if [[ $name = @* ]]; then
            lists[$name]=$(paths_of "$place") || exit
            continue
        fi
        if [[ ! $place =~ ^(alone|beside)$ || ! $minutes =~ ^[0-9]+$ || ! $parts =~ ^[0-9]+$ || -z $command ]]; then
            fail "$table: $name: write NAME, alone or beside, minutes and number of parts, sources, files and command"
        fi
        names="$names $name"
        [ -z "$only" ] || [[ " $only " = *" $name "* ]] || continue
        sources=$(paths_of "$sources") || exit
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
        left=$((minutes * (parts - $(parts_that_stay))))
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
# How many parts of these sources are in WORK.
parts_in_work() {
    if [ "$(cat "$work/$name/.sources" 2>/dev/null)" = "$hash" ]; then
        parts_passed | wc -l
    else
        echo 0
    fi
}
# How many parts need not be run again.
parts_that_stay() {
    local here recorded
    here=$(parts_in_work) recorded=$(recorded_parts "$(newest)" | wc -w)
    echo $((here > recorded ? here : recorded))
}
# Makes one part, which counts as number 0, of those of a record.
lay_back() { # STUDY.JSON FOLDER
    cp -r "$(dirname "$1")" "$2"
    value "$1" load_before >"$2/.load"
    value "$1" seconds >"$2/.seconds"
    echo 0 >"$2/.status"
    echo "$(value "$1" continues) $(value "$1" commit)" | xargs >"$2/.continues"
}
# Makes WORK/STUDY one of these sources: as it is, from the record if that has more parts, or empty.
prepare_work() {
    local folder=${work:?}/$name record part parts_of_record here
    record=$(newest) here=$(parts_in_work)
    parts_of_record=$(recorded_parts "$record")
    if [ "$(wc -w <<<"$parts_of_record")" -gt "$here" ]; then
        rm -rf "$folder"
        mkdir -p "$folder"
        lay_back "$record" "$folder/part-0"
        for part in $parts_of_record; do
            mkdir "$folder/part-$part"
            touch "$folder/part-$part/.passed"
        done
    elif [ "$(cat "$folder/.sources" 2>/dev/null)" != "$hash" ]; then
        rm -rf "$folder"
        mkdir -p "$folder"
    fi
    echo "$hash" >"$folder/.sources"
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
    ! is_late || return 75
    if [ "$place" = alone ] && [ -z "$busy" ] && ! is_quiet; then
        fail "$name measures times, and other programs run; end them, or record them with BUSY=1"
    fi
    mkdir -p "$out"
    rm -f "$out/.status"
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
# Writes the record of the parts that have ended, if there are any.
keep() {
    local folder=$records/$commit/$name part passed failed checks folders
    compgen -G "$work/$name/part-[1-9]*/.status" >/dev/null || return 0
    mapfile -t folders < <(find "$work/$name" -mindepth 2 -maxdepth 2 -name .status -printf '%h\n' | sort -V)
    rm -rf "$folder.part"
    mkdir -p "$folder.part"
    for part in "${folders[@]}"; do # of one name the last part's file stays
        keep_files "$part" "$folder.part"
    done
    passed=$(parts_passed | xargs)
    failed=$(cat "${folders[@]/%//.status}" | awk '$1 != 0 { ++n } END { print n + 0 }')
    mapfile -t checks < <(find "${folders[@]}" -maxdepth 1 -name checks.tsv)
    [ ${#checks[@]} = 0 ] || sum_checks "${checks[@]}" >"$folder.part/checks.tsv"
    cat >"$folder.part/study.json" <<JSON
{
  "study": "$name",
  "commit": "$commit",
  "continues": "$(cat "$work/$name/part-0/.continues" 2>/dev/null)",
  "ended": "$(date -u +%Y-%m-%dT%H:%M:%S.%3NZ)",
  "machine": "$(processor), $(nproc) cores, $(uname -sr)",
  "place": "$place",
  "load_before": $(sort -g "${folders[@]/%//.load}" | tail -1),
  "seconds": $(cat "${folders[@]/%//.seconds}" | awk '{ s += $1 } END { print s + 0 }'),
  "parts": $parts,
  "parts_done": $(wc -w <<<"$passed"),
  "parts_passed": "$passed",
  "failed": $failed,
  "sources": "$sources",
  "sources_hash": "$hash",
  "program": "$program",
  "command": "$(sed 's/[\\"]/\\&/g' <<<"$command")"
}
JSON
    rm -rf "$folder"
    mv "$folder.part" "$folder"
    echo "$folder: $(wc -w <<<"$passed") of $parts parts passed, $failed failed"
}
# Parts whose times do not matter run JOBS at a time.
run_parts() {
    local part at_once=1 ended=0 status pid pids=()
    [ "$place" = alone ] || at_once=$jobs
    for part in $(seq "$parts"); do
        [ ! -e "$work/$name/part-$part/.passed" ] || continue
        run_part "$part" &
        pids+=($!)
        while [ "$(jobs -rp | wc -l)" -ge "$at_once" ] && [ $ended = 0 ]; do
            wait -n || ended=$?
            keep
        done
        [ $ended = 0 ] || break
    done
    for pid in "${pids[@]}"; do
        status=0
        wait "$pid" 2>/dev/null || status=$?
        case $status in
        0 | 127) ;; # 127: it ended long ago, as a number that the system has given to another since
        *) ended=$status ;;
        esac
    done
    [ "$at_once" = 1 ] || keep # of those that ended together
    case $ended in
    0) ;;
    75) late="$late $name" ;;
    *) exit "$ended" ;;
    esac
}
# In fresh records whose files have changed: that the program of these files is the same, or their code.
note_same_program() {
    local file
    while next_study; do
        file=$(newest)
        [ -z "$(staleness)" ] || continue
        has_these_sources "$file" ||
            sed -i -e '/^ *"same_/d' \
                -e "s/^\( *\)\"sources_hash\".*/&\n\1\"same_program\": \"$hash\",\n\1\"same_commit\": \"$commit\",/" "$file"
    done
}
run_study() {
    [ -n "$(staleness)" ] || return 0
    prepare_work
    run_parts
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
