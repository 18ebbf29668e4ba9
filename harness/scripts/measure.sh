# measure ARGUMENT...: one mote run into $out by $mote; a failed cell (5) is a row of the table, is
# recorded in $failed and does not end the script. The summary of all is left to the script's end: of a
# full bench it takes minutes. Sourced by bench.sh, tune.sh and verdicts.sh.
failed=0
measure() {
    status=0
    "$mote" run "$@" --out "$out" --progress 10 --no-summary >/dev/null || status=$?
    case $status in
    0) ;;
    5) failed=5 ;;
    *) exit "$status" ;;
    esac
}
