#!/bin/sh
# build.sh OUT: bundles the replay with three.js, and its licence, into OUT/replay.js. If npm or its
# packages are not available, says so and writes no bundle: reports then have no replay.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$1"
out=$(cd "$1" && pwd)
fail() {
    rm -f "$out/replay.js"
    echo "page: $1; reports will have no replay" >&2
    exit 0
}
command -v npm >/dev/null || fail 'npm is not there (Debian: apt-get install npm)'
cd "$here"
if [ ! -d node_modules ] || [ package-lock.json -nt node_modules/.package-lock.json ]; then
    npm ci --ignore-scripts --no-audit --no-fund >"$out/npm.log" 2>&1 ||
        fail "npm ci failed: $(tail -n 1 "$out/npm.log")"
fi
licence=$(sed 's/\*\// /' node_modules/three/LICENSE)
node_modules/.bin/esbuild start.js --bundle --minify --format=iife --target=es2021 --charset=utf8 \
    --legal-comments=inline --log-level=warning --banner:js="/* three.js:
$licence */" --outfile="$out/replay.js.part" || fail 'esbuild failed'
mv "$out/replay.js.part" "$out/replay.js"
