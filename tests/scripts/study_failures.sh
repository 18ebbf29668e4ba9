#!/bin/bash
# study_failures.sh SCRIPTS: do the scripts of studies (in SCRIPTS) that print a table end with the status of the
# program that makes it? The programs here only say what they are asked to, and end with $ENDS.
set -euo pipefail
scripts=$(realpath "$1")
. "$(dirname "$0")/work.sh"
shown=said
cd "$work"
mkdir -p build/tests harness/scripts
# What mote and race_study do: measure, and make tables.
cat >mote <<'MOTE'
#!/bin/sh
for argument in "$@"; do last=$argument; done
case $1 in
run) ;;
summarize) mkdir -p "$2" && echo scene,frames,replicates >"$2/summary.csv" && echo "a table" && exit "$ENDS" ;;
table) : >"$last.dat" && echo "a table" && exit "$ENDS" ;;
esac
MOTE
printf '#!/bin/sh\n' >harness/scripts/relink.sh
chmod +x mote harness/scripts/relink.sh
cp mote build/tests/race_study
export ENDS
# script_ends TABLE SCRIPT ARGUMENT...: the script prints what it keeps in out/TABLE, or ends as the program does.
script_ends() {
    local table=$1 script=$2 status
    shift 2
    for ENDS in 0 4; do
        rm -rf out && mkdir out
        status=0
        "$scripts/$script" "$@" >said 2>&1 || status=$?
        [ $status = $ENDS ] || fail "$script ends with $status where a program ends with $ENDS"
        [ $ENDS != 0 ] || grep -qxF -f "out/$table" said || fail "$script does not print $table"
    done
}
script_ends ablation.txt ablation.sh ./mote quick out
script_ends ingredients.txt ingredients.sh ./mote quick out
script_ends characters.md character_speed.sh ./mote quick out
script_ends power.md perf_study.sh build out 1 0 ''
echo "study_failures.sh: no failure is lost"
