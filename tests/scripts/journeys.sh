#!/bin/bash
# journeys.sh BUILD: what users do, with the installed program and far from any clone: meshes of their
# own in a folder with an odd name, a pair, a sweep, comparisons, motions found and recorded, exports,
# reports, figures, the help, output to links and devices, Ctrl-C. Each step is checked by its output,
# against closed forms where they exist.
set -euo pipefail
build=$(realpath "$1")
. "$(dirname "$0")/work.sh"
export LC_ALL=C.UTF-8
step=start
shown="out err"

cmake --install "$build" --prefix "$work/it's in/mote" > "$work/log" || fail "cannot be installed"
mote="$work/it's in/mote/bin/mote"
home="$work/Mein Körper's \"100 %\""
mkdir -p "$home/meshes" "$home/elsewhere/below"
cd "$home"

# do STATUS ARGUMENT...: runs mote, which must end with STATUS, and keeps both outputs.
do_() {
    local wanted=$1 status=0
    shift
    step="mote $*"
    "$mote" "$@" > "$work/out" 2> "$work/err" || status=$?
    [ "$status" -eq "$wanted" ] || fail "status $status, not $wanted"
}
# One line of an error, and nothing on standard output.
refuses() {
    do_ "$@"
    [ "$(grep -c '^mote: ' "$work/err")" -eq 1 ] && [ ! -s "$work/out" ] || fail "not one line of an error"
}
number() { awk -v value="$1" -v wanted="$2" -v error="$3" 'BEGIN { d = value - wanted
    exit !(value != "" && d <= error && -d <= error) }' || fail "$1 is not $2 +- $3"; }

# field NAME FILE: a number in JSON with one field a line.
field() { awk -F '[:,]' -v key="\"$1\"" '$1 ~ key { print $2 + 0; exit }' "$2"; }

# box X Y Z LEFT: a box of that size with its low corner at LEFT, 0, 0.
box() {
    awk -v x="$1" -v y="$2" -v z="$3" -v left="$4" 'BEGIN {
        for (i = 0; i < 8; ++i)
            printf "v %.17g %.17g %.17g\n", left + (i % 2 ? x : 0), int(i / 2) % 2 ? y : 0, (i > 3 ? z : 0)
        print "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6" }'
}
box 1 1 1 0 > "meshes/cube é.obj"
box 1 1 1 4 > meshes/away.obj
box 2 3 6 0 > meshes/-brick.obj
box 1e-6 1e-6 1e-6 5 > meshes/mite.obj
awk 'BEGIN { n = 32; m = 12; turn = 2 * 3.14159265358979
    for (i = 0; i < n; ++i) for (j = 0; j < m; ++j) { r = 1 + 0.2 * cos(turn * j / m)
        printf "v %.12f %.12f %.12f\n", r * cos(turn * i / n), r * sin(turn * i / n), 0.2 * sin(turn * j / m) }
    for (i = 0; i < n; ++i) for (j = 0; j < m; ++j) { k = (i + 1) % n; l = (j + 1) % m
        print "f", i * m + j + 1, k * m + j + 1, k * m + l + 1, i * m + l + 1 } }' > meshes/ring.obj

# --- a mesh, and the distance of two
do_ 0 mesh -- meshes/-brick.obj
says "vertices            8"
says "L                   7"   # sqrt(4 + 9 + 36)
do_ 0 mesh meshes/ring.obj
says "Euler               0"
do_ 0 distance "meshes/cube é.obj" meshes/away.obj --method certified --method fcl-aabb --method brute-force
[ "$(grep -c 'distance 3, \|distance 3\.0*, ' "$work/out")" -eq 3 ] || fail "not 3 apart"
# The same cube in other formats, as other programs write them.
corners='0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n'
faces='4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n'
printf "OFF\n8 6 0\n$corners$faces" > meshes/cube.off
{
    printf 'ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\n'
    printf "property float z\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n$corners$faces"
} > meshes/cube.ply
printf "$corners" | awk '{ x[NR - 1] = $0 } END {
    count = split("0 2 1 0 3 2 4 5 6 4 6 7 0 1 5 0 5 4 1 2 6 1 6 5 2 3 7 2 7 6 3 0 4 3 4 7", at, " ")
    print "solid cube"
    for (i = 1; i <= count; i += 3)
        printf "facet normal 0 0 0\nouter loop\nvertex %s\nvertex %s\nvertex %s\nendloop\nendfacet\n",
               x[at[i]], x[at[i + 1]], x[at[i + 2]]
    print "endsolid cube" }' > meshes/cube.stl
for file in cube.off cube.ply cube.stl; do
    do_ 0 mesh "meshes/$file"
    says "open edges          0"
    do_ 0 distance "meshes/$file" meshes/away.obj --method certified
    number "$(awk '{ print $3 + 0 }' "$work/out")" 3 1e-15
done
do_ 0 check pair:meshes/cube.ply:meshes/cube.stl
says "1000 frames, truth from 0 to 0.4"
step="a name that begins with a dash"
(cd meshes; "$mote" distance -- -brick.obj away.obj) > "$work/out" || fail "is not read"
says "distance 2"

# --- a pair: contact in 10 to 20 % of 1,000 frames, from 100 to 200 on, and 0.4 L apart at the end
cd elsewhere/below
pair=("../../meshes/cube é.obj" "$home/meshes/ring.obj")
do_ 0 check "pair:${pair[0]}:${pair[1]}"
awk '/^1000 frames, truth from 0 to 0.4/ { for (i = 1; i < NF; ++i) if ($i == "in") count = $(i + 1) }
    END { exit !(count >= 100 && count <= 200) }' "$work/out" || fail "not the contacts that are promised"
do_ 0 check "pair:${pair[0]}:../../meshes/mite.obj" --json # sizes differ by a factor of 1,000,000
contacts=$(field contacts "$work/out")
[ "$contacts" -ge 100 ] && [ "$contacts" -le 200 ] || fail "$contacts contacts"
ln -s ../../meshes/ring.obj link.obj
do_ 0 run --pair "${pair[0]}" link.obj --method certified --method particle --method fcl-aabb \
    --frames 101-220 --replicates 2 --out "run ü"
says "cube é-link: 12 and 768 triangles, 120 frames, 2 replicates"
do_ 0 summarize "run ü" --format csv
# column NAME METHOD: a value of the CSV, whose names have no commas.
column() { awk -F , -v name="$1" -v method="$2" 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next }
    { gsub(/"/, "") } $at["method"] == method { print $at[name]; exit }' "$work/out"; }
[ "$(column frames certified)" -eq 120 ] || fail "not 120 frames"
number "$(column error_max certified)" 0 1e-9
number "$(column exact_rate certified)" 1 0
number "$(column missed fcl-aabb)" 0 0
number "$(column ratio fcl-aabb)" 1 0
contacts=$(column contacts certified)
[ "$contacts" -gt 0 ] && [ "$contacts" -lt 120 ] || fail "$contacts contacts in frames 101 to 220"
# Once more, from another folder: nothing is measured again.
cd "$home"
do_ 0 run --pair "meshes/cube é.obj" meshes/ring.obj --method certified --frames 1-1 --dry-run
tells "plan: 3 cells, 0 of them done"
do_ 4 run --pair "meshes/cube é.obj" meshes/ring.obj --method particle:n=9 --frames 1-2 --out x
tells "particle:n=9 on cube é-ring: "
do_ 0 run --pair "meshes/cube é.obj" "meshes/cube é.obj" --direction 0,0,2 --method certified \
    --frames 1-9 --replicates 1 --out z
do_ 2 run --pair "meshes/cube é.obj" "meshes/cube é.obj" --direction 0,0,0
refuses 4 check "pair:meshes/cube é.obj:meshes/none.obj"
tells "meshes/none.obj: No such file or directory; name a mesh file"

# --- a sweep, stopped by Ctrl-C, resumed, and compared
sweep=(run tt --method particle --particles '1,2,4-5' --method certified --frames 140-170
    --replicates 10 --out sweep)
# interrupt FILE ARGUMENT...: Ctrl-C as soon as FILE exists; as at a terminal, the whole group gets it.
interrupt() {
    local file=$1 status=0
    shift
    step="Ctrl-C in mote $*"
    env --default-signal=INT setsid "$mote" "$@" > "$work/out" 2> "$work/err" &
    for ((i = 0; i < 400; ++i)); do
        sleep 0.05
        ! compgen -G "$file" > "$work/log" || [ ! "/proc/$!/exe" -ef "$mote" ] || break
    done
    kill -INT -- "-$!"
    wait "$!" || status=$?
    [ "$status" -eq 130 ] || fail "status $status, not 130"
}
interrupt 'sweep/cells/*.json' "${sweep[@]}"
tells "stopped by a signal; run the same command again to go on"
ls sweep/cells/*.json > "$work/before"
kept=$(wc -l < "$work/before")
[ "$kept" -ge 1 ] && [ "$kept" -lt 50 ] || fail "$kept cells are there"
do_ 0 "${sweep[@]}"
tells "plan: 50 cells, $kept of them done"
[ -z "$(find sweep -name '*.part*')" ] || fail "parts of files are left"
# Interrupts while a large scenario is loaded, before anything is measured.
started=$SECONDS
interrupt /proc/self run ww-1m --method certified --out never
[ $((SECONDS - started)) -le 5 ] && [ ! -e never ] || fail "goes on after Ctrl-C"

do_ 0 compare sweep sweep
says "same or better"
do_ 0 compare sweep sweep --format json
says '"verdict": "same-or-better"'
do_ 0 run tt --method certified --frames 140-170 --replicates 10 --out other
status=0
"$mote" compare sweep other > "$work/out" 2> "$work/err" || status=$?
step="mote compare sweep other"
[ "$status" -eq 1 ] || [ "$status" -eq 3 ] || fail "status $status where rows are missing"
says "without a partner: 4 rows of BASE, 0 of NEW"
refuses 4 compare sweep meshes
tells "meshes: neither cells nor a summary.json"
do_ 0 tune sweep
says "of 4"
do_ 0 merge both sweep other
# Equal configuration, replicate and program mean the same cell.
tells "both: 50 cells copied, 10 were there"

# --- motions: found and recorded, read back from other folders
do_ 0 approach "pair:meshes/cube é.obj:meshes/ring.obj" --gaps 1:0.5,500:0.125,1000:-0.01 --every 250 \
    -o elsewhere/found.json
[ -e elsewhere/found-body0.obj ] && [ -e elsewhere/found-body1.obj ] || fail "no copies of the meshes"
mv elsewhere moved
cd moved/below
L=$(awk 'BEGIN { printf "%.15g", sqrt(2 * 2.4 * 2.4 + 0.16) }') # of the ring, the larger one
for gap in 1:0.5 500:0.125 1000:0; do
    do_ 0 export ../found.json --frame "${gap%:*}" --out "$work/frame" --method certified --method fcl-aabb
    for method in certified fcl-aabb; do
        found=$(awk -v method="\"$method\"" '$1 ~ method { in_it = 1 }
            in_it && $1 ~ /"distance"/ { print $2 + 0; exit }' "$work/frame/answers.json")
        number "$(awk -v d="$found" -v L="$L" 'BEGIN { print d / L }')" "${gap#*:}" 1e-3
    done
    do_ 0 distance "$work/frame/A.obj" "$work/frame/B.obj" --method fcl-aabb
    number "$(awk '{ print $3 + 0 }' "$work/out")" "$found" 1e-12
done
cd "$home"
mv moved elsewhere

# Two cubes 2 apart move straight at each other, by 0.1 a frame together: they bounce at frame 21.
cat > cubes.json << 'JSON'
{"purpose": "Two cubes on a line.", "frames": 40, "ask": "distance", "bodies": [
 {"file": "meshes/cube é.obj", "velocity": [0.028867513459481287, 0, 0]},
 {"file": "meshes/cube é.obj", "velocity": [-0.028867513459481287, 0, 0],
  "motion": [{"frame": 1, "position": [1.7320508075688772, 0, 0]}]}]}
JSON
printf '\357\273\277' | cat - cubes.json > marked.json
for scenario in cubes.json ./marked.json "$home/cubes.json"; do
    do_ 0 simulate "$scenario" --method certified --json --trace elsewhere/bounce.json
    number "$(field approaches "$work/out")" 1 0
    number "$(field passes_through "$work/out")" 0 0
    number "$(field momentum_drift "$work/out")" 0 1e-12
    number "$(field energy_drift "$work/out")" 0 1e-12
done
cd elsewhere/below
do_ 0 check ../bounce.json
says "contact in "
do_ 0 simulate "$home/cubes.json" --method certified --trace /dev/stdout --steps 2
[ "$(head -c 1 "$work/out")" = "{" ] && [ "$(tail -n 1 "$work/out")" = "}" ] ||
    fail "more than the scenario in what goes to standard output"
tells "2 steps"
cd "$home"

# --- a scenario file may name files in its folder, links included, and others only if allowed
mkdir -p fence/inside
sed 's,meshes/cube é.obj,link.obj,' cubes.json > fence/linked.json
ln -s "../meshes/cube é.obj" fence/link.obj
sed 's,meshes/cube é.obj,../meshes/away.obj,' cubes.json > fence/out.json
do_ 0 check fence/linked.json
says "truth from 1.155 to 1.155 L"
refuses 4 check fence/out.json
tells "fence/out.json:2: bodies[0].file: fence/../meshes/away.obj lies outside of the scenario's folder"
(cd fence/inside; "$mote" --allow ../../meshes check ../out.json) > "$work/out" || fail "--allow"
says "truth from 1.155 to 1.155 L"

# --- figures and reports of a run
do_ 0 figures "elsewhere/below/run ü"
! grep -qi warning "$work/err" || fail "warnings"
front="elsewhere/below/run ü/figures/front-cube___-link"
for format in svg png pdf dat; do compgen -G "$front*.$format" > "$work/log" || fail "no $front*.$format"; done
cd /
do_ 0 report "$home/elsewhere/below/run ü"
cd "$home"
for file in report.html report.md; do
    grep -qF "cube é-link" "elsewhere/below/run ü/$file" || fail "$file does not name the scenario"
    grep -qF "particle" "elsewhere/below/run ü/$file" || fail "$file does not name a method"
done
do_ 0 history --add sweep --why "a journey" kept.csv
do_ 0 history kept.csv
[ -s kept.svg ] || fail "no picture"

# --- help
do_ 0 --help
says "pair:A.obj:B.obj"
commands=$(sed -n 's/^  mote \([a-z]*\).*/\1/p' "$work/out")
[ "$(wc -w <<< "$commands")" -ge 20 ] || fail "few commands"
manual="$work/it's in/mote/share/man/man1/mote.1"
completion="$work/it's in/mote/share/bash-completion/completions/mote"
for command in $commands; do
    do_ 0 "$command" --help
    grep -oE '^  --?[a-z-]+' "$work/out" | sort -u > "$work/options" || true
    while read -r option; do
        grep -qF -- "${option//-/\\-}" "$manual" || fail "the manual does not tell of $option"
    done < "$work/options"
done
do_ 0 run --help
says "--pair A.obj B.obj"
step="completion"
(
    # shellcheck disable=SC1090
    source "$completion"
    compopt() { :; } # works in an interactive completion only
    COMP_WORDS=("$mote" run --p) COMP_CWORD=2
    _mote
    [[ " ${COMPREPLY[*]} " == *" --pair "* ]]
) || fail "no --pair"

# --- output: links stay, devices stay, a plain file is replaced in one step
mkdir links
echo old > links/target.obj
ln -s target.obj links/link.obj
exec 3< links/target.obj # a reader that has it open continues with the old file
do_ 0 letter T --triangles 500 -o links/link.obj
[ -L links/link.obj ] && [ "$(head -c 2 links/target.obj)" = "v " ] || fail "not through the link"
[ "$(cat <&3)" = old ] || fail "written into a file that somebody reads"
exec 3<&-
do_ 0 letter T --triangles 500 -o /dev/stdout
cmp "$work/out" links/target.obj || fail "another mesh on standard output"
do_ 0 letter T --triangles 500 -o /dev/null
[ -c /dev/null ] || fail "/dev/null is gone"
refuses 4 letter T --triangles 500 -o /dev/full
tells "/dev/full: cannot be written: No space left on device"
refuses 4 letter T --triangles 500 -o nowhere/t.obj
tells "mote: nowhere/t.obj: cannot be created: No such file or directory"
step="a file that becomes larger than is allowed"
status=0
(ulimit -f 8; "$mote" letter T --triangles 5000 -o large.obj) > "$work/out" 2> "$work/err" || status=$?
[ "$status" -eq 4 ] || fail "status $status"
tells "large.obj: cannot be written: File too large"
[ -z "$(find . -name 'large*')" ] || fail "a part of it is left"
step="mote list methods > /dev/full"
status=0
"$mote" list methods > /dev/full 2> "$work/err" || status=$?
[ "$status" -eq 4 ] || fail "status $status"
tells "standard output: cannot be written"

# --- files that are not meshes, scenarios or runs
: > empty.obj
mkdir hollow gone
for bad in empty.obj hollow gone/none.obj /dev/null; do refuses 4 mesh "$bad"; done
for bad in hollow meshes/away.obj gone; do
    for command in summarize tune report figures; do
        do_ 4 "$command" "$bad"
        tells "name the directory of a run"
    done
done
cd gone
rmdir ../gone
refuses 4 letter T --triangles 500 -o t.obj
do_ 0 mesh "$home/meshes/away.obj"
do_ 0 run tt --frames 1-2 --method certified --replicates 1 --out "$home/from gone"
[ -s "$home/from gone/summary.json" ] || fail "nothing is there"
cd "$home"
if [ "$(id -u)" -ne 0 ]; then
    mkdir closed
    chmod a-w closed
    do_ 4 run tt --frames 1-2 --method certified --replicates 1 --out closed/run
    tells "Permission denied; name a directory that can be written to"
fi
# Names that would break a line, a format, a page or a figure.
for name in $'new\nline' '%s%n' '<b>&"' "it's"; do
    cp meshes/ring.obj "$name.obj"
    do_ 0 run --pair "$name.obj" meshes/away.obj --method certified --frames 1-3 --replicates 1 --out odd
    [ "$(grep -c ' replicates\?, caches hot' "$work/out")" -eq 1 ] || fail "the table's head is no line"
    do_ 0 summarize odd --format csv
    [ "$(wc -l < "$work/out")" -eq 2 ] || fail "more lines than rows"
    do_ 0 report odd
    ! grep -qF '<b>&"' odd/report.html || fail "the name is not escaped in the page"
    rm -r odd
done
echo "journeys: meshes, pairs, a sweep, motions, figures, help and output as a user does them, in ${SECONDS} s"
