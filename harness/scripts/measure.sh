# measure ARGUMENT...: one mote run into $out by $mote; a cell that failed (5) is a row of the
# table, not the end, and is kept in $failed. Sourced by bench.sh and tune.sh.
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
