#!/bin/sh
# fcl_flags.sh BUILD OUT: races mote with Debian's FCL against mote with FCL compiled here by our flags, on the
# same frames in turn. Its sources are those of FCL_DIR, else Debian's of the version installed, which
# `apt-get source` fetches by the machine's own package sources, without root. FCL_FLAGS: more flags, such as
# -march=native. FCL needs Eigen and libccd, which packages.txt has for Debian's FCL; dpkg-dev unpacks the
# sources. BUDGET: seconds for the race (240). What is built is kept in build-fcl.
set -eu
mote=$1/mote
out=$2
cache=$PWD/build-fcl
flags="-O3 -DNDEBUG -ffp-contract=off${FCL_FLAGS:+ $FCL_FLAGS}"
mkdir -p "$cache" "$out"

# The machine's package sources, as sources of source packages; apt's own lists stay as they are.
fetch() {
    mkdir -p "$cache/apt/parts" "$cache/apt/lists/partial" "$cache/source"
    for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.list /etc/apt/sources.list.d/*.sources; do
        if [ -f "$file" ]; then
            sed 's/^deb /deb-src /; s/^Types: deb$/Types: deb-src/' "$file" >"$cache/apt/parts/$(basename "$file")"
        fi
    done
    set -- -o Dir::Etc::sourcelist=/dev/null -o "Dir::Etc::sourceparts=$cache/apt/parts" \
        -o "Dir::State::lists=$cache/apt/lists"
    # The sources.list of old has no ending that apt would take in a folder.
    if [ -f "$cache/apt/parts/sources.list" ]; then mv "$cache/apt/parts/sources.list" "$cache/apt/parts/main.list"; fi
    apt-get "$@" update && (cd "$cache/source" && apt-get "$@" source fcl)
}

if [ -z "${FCL_DIR:-}" ]; then
    if ! ls -d "$cache"/source/fcl-*/ >/dev/null 2>&1; then
        echo 'fcl_flags.sh: fetching the source package fcl' >&2
        fetch >"$cache/fetch.log" 2>&1 || {
            echo "fcl_flags.sh: no source package ($cache/fetch.log); name a folder with FCL's sources: FCL_DIR=..." >&2
            exit 4
        }
    fi
    FCL_DIR=$(find "$cache/source" -maxdepth 1 -type d -name 'fcl-*' | head -1)
fi

# Ten minutes the first time. Octomap is left out: nothing here asks it.
echo "fcl_flags.sh: compiling $FCL_DIR with $flags" >&2
{
    cmake -S "$FCL_DIR" -B "$cache/fcl" -DCMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_FLAGS_RELEASE=$flags" \
        -DCMAKE_INSTALL_PREFIX="$cache/prefix" -DCMAKE_INSTALL_LIBDIR=lib -DFCL_STATIC_LIBRARY=ON \
        -DFCL_WITH_OCTOMAP=OFF -DFCL_USE_HOST_NATIVE_ARCH=OFF -DBUILD_TESTING=OFF &&
        cmake --build "$cache/fcl" --parallel "$(nproc)" --target install &&
        PKG_CONFIG_PATH=$cache/prefix/lib/pkgconfig cmake -S . -B "$cache/mote" -DCMAKE_BUILD_TYPE=Release \
            "-DCMAKE_CXX_FLAGS=${FCL_FLAGS:-}" &&
        cmake --build "$cache/mote" --parallel "$(nproc)" --target mote
} >"$cache/build.log" 2>&1 || {
    tail -20 "$cache/build.log" >&2
    echo "fcl_flags.sh: it does not build: $cache/build.log" >&2
    exit 4
}
if nm -DC --undefined-only "$cache/mote/mote" | grep -q ' fcl::'; then
    echo "fcl_flags.sh: $cache/mote/mote has Debian's FCL still" >&2
    exit 1
fi

# race NAME ARGUMENT...: which build is slower was asked, not whether one is.
race() {
    name=$1
    shift
    status=0
    "$mote" race "$mote" "$cache/mote/mote" "$@" --budget $((${BUDGET:-240} / 2)) --labels debian,ours \
        --out "$out/fcl-flags-$name.json" || status=$?
    case $status in
    0 | 1 | 3) ;;
    *) exit $status ;;
    esac
}

echo "B / A: B has FCL compiled here ($flags), A Debian's"
race deforming ww@1241-1260 mv@401-420 ww-contact@1241-1260 mv-contact@401-420 \
    --method fcl-aabb --method fcl-aabb:seed=previous --method fcl-obb
race rigid tt@281-320 tt-distance@281-320 --method fcl-obb:update=none --method fcl-rss:update=none \
    --method fcl-obbrss:update=none
