# measure ARGUMENT...: one mote run into $out by $mote; a failed cell (5) is a row of the table, is
# recorded in $failed and does not end the script. Sourced by bench.sh and tune.sh.
failed=0
measure() {
    status=0
    "$mote" run "$@" --out "$out" --progress 10 >/dev/null || status=$?
    case $status in
    0) ;;
    5) failed=5 ;;
    *) exit "$status" ;;
    esac
}
