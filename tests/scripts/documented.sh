#!/bin/sh
# documented.sh NAME [FILE]: prints the code block of docs/extending.md (or FILE) below the comment
# <!-- NAME -->, so that tests use the code that readers see.
set -eu
file=${2:-$(dirname "$0")/../../docs/extending.md}
text=$(awk -v mark="<!-- $1 -->" '
    $0 == mark { found = 1; next }
    found && /^```/ { if (inside) exit; inside = 1; next }
    inside { print }' "$file")
[ -n "$text" ] || { echo "$file: no block below <!-- $1 -->" >&2; exit 1; }
printf '%s\n' "$text"
