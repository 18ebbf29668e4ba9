#!/bin/sh
# locked.sh FOLDER COMMAND...: runs the command while no other call with this folder runs one, so that two
# makes at once do not write the same build. Where flock is missing, the command runs at once.
set -eu
lock=$1/.lock
shift
if ! command -v flock >/dev/null; then
    exec "$@"
fi
flock --nonblock "$lock" true || echo "waiting for another make, which builds here" >&2
exec flock --close "$lock" "$@"
