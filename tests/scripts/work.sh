# work.sh: sourced by a test before it leaves the folder that it was started in. A folder of the test's own, $work,
# which is removed when the test ends, and how the test fails.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# fail TEXT...: ends the test. Names it and, where it has some, its $step, and shows the ends of the files in $work
# that $shown names.
fail() {
    echo "$(basename "$0"): ${step:+$step: }$*" >&2
    for file in ${shown:-}; do
        [ ! -s "$work/$file" ] || { echo "-- $file"; tail -n 20 "$work/$file"; } >&2
    done
    exit 1
}

# says TEXT, tells TEXT: whether the standard output in $work/out, the standard error in $work/err, has it.
says() { grep -qF -- "$1" "$work/out" || fail "does not print: $1"; }
tells() { grep -qF -- "$1" "$work/err" || fail "does not tell: $1"; }
