#!/bin/sh
# perf_ab.sh BUILD OUT [BASE]: races a base revision against the build in BUILD, on the fixed set of
# perf.sh, within five minutes. BASE: any revision; by default the commit of the accepted reference. Its
# build is kept in build-perf-ab/COMMIT, the last KEEP of them. Writes OUT/DATE.json and OUT/last.json.
# Exit status as for `mote compare`; 4 if BASE cannot be raced. CHANGED=1: answers may differ.
set -eu
build=$1
out=$2
cache="build-perf-ab"
keep=3
# Orders of objects, in the programs that are linked from each build: these are the sample. For an interval, twelve
# rows need 14; with 14 it reaches twice the spread of the pairs of programs to either side, and with 24 about as far
# as the spread, which is 0.5 to 1.6 %. Linking takes 1 to 2 s for each.
orders=${ORDERS:-24}
budget=${BUDGET:-270} # seconds for the race; BASE is built once, which comes on top

fail() {
    echo "perf-ab: $1" >&2
    exit 4
}

revision=${3:-}
if [ -z "$revision" ]; then
    revision=$(sed -n 's/^ *"commit": "\([0-9a-f]*\).*/\1/p' results/reference/manifest.json 2>/dev/null | head -1)
    [ -n "$revision" ] || fail "there is no accepted reference; name a revision: make perf-ab BASE=HEAD~1"
fi
base=$(git rev-parse --verify --quiet "$revision^{commit}") || fail "$revision: no such commit here; fetch it, or name another"
if ! git cat-file -e "$base:harness/race/race_child.c" 2>/dev/null; then
    fail "$revision: from before \`mote race\`, and has no program that can race; name a newer one: make perf-ab BASE=REVISION"
fi

build_base() {
    cmake -S "$folder/source" -B "$folder/build" -DCMAKE_BUILD_TYPE=Release &&
        cmake --build "$folder/build" --parallel "$(nproc)" --target mote
}

# Whether the sources of BASE are present and unchanged.
has_source() {
    [ "$(git -C "$folder/source" rev-parse HEAD 2>/dev/null)" = "$base" ] &&
        [ -z "$(git -C "$folder/source" status --porcelain -uno)" ]
}

# Builds BASE once; an interrupted build is continued. The folder of programs is made when it is complete.
make_base() {
    folder=$cache/$base
    if [ ! -d "$folder/programs" ]; then
        mkdir -p "$folder"
        git worktree prune
        if ! has_source; then
            git worktree remove --force "$folder/source" 2>/dev/null || rm -rf "$folder/source"
            git worktree add --quiet --detach "$folder/source" "$base"
        fi
        echo "perf-ab: building $revision ($(git log -1 --format=%h "$base")) once" >&2
        build_base >"$folder/build.log" 2>&1 || fail "$revision does not build: $folder/build.log"
        mkdir "$folder/programs"
    fi
    harness/scripts/relink.sh "$folder/build" "$orders" "$folder/programs"
    touch "$folder/programs"
    # shellcheck disable=SC2012
    ls -dt "$cache"/*/programs | tail -n +$((keep + 1)) | while read -r old; do
        git worktree remove --force "${old%programs}source" 2>/dev/null || true
        rm -rf "${old%programs}"
    done
}

now=$(git rev-parse --short=10 HEAD)
[ -z "$(git status --porcelain -uno)" ] || now=$now-changed
make_base
harness/scripts/relink.sh "$build" "$orders" "$cache/now"
mkdir -p "$out"
file=$out/$(date -u +%Y%m%dT%H%M%SZ).json
status=0
# The race ends with this script, however the script ends.
with_us=
if setpriv --pdeathsig TERM true 2>/dev/null; then
    with_us="setpriv --pdeathsig TERM"
fi
$with_us "$build/mote" race "$cache/$base/programs" "$cache/now" ww@950-1149 mv@300-499 --particles 5,16 \
    --method certified --method particle --method particle-paper:start=fps --method aabb-tree \
    --budget "$budget" --instructions --labels "$(git rev-parse --short=10 "$base"),$now" --out "$file" \
    ${CHANGED:+--allow-changes} || status=$?
[ ! -f "$file" ] || cp "$file" "$out/last.json"
exit "$status"
