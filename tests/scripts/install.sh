#!/bin/bash
# install.sh BUILD: installs a build into a folder of its own as `make install` does, removes it again, moves it, and
# uses it as a stranger would: the documented program by pkg-config and by find_package, with the shared
# and with the static library, every header alone from C and C++, the manual and the completion.
set -euo pipefail
build=$(realpath "$1")
tests=$(realpath "$(dirname "$0")")
. "$(dirname "$0")/work.sh"
cd "$work"

# make_line TARGET [VARIABLE=VALUE...]: the last line that make would run; the lines before it only build.
make_line() {
    echo "cd $(printf %q "$tests/../..")"
    env -u MAKEFLAGS -u MAKELEVEL make -s -n -C "$tests/../.." BUILD="$build" "$@" | tail -n 1
}
# A prefix is one word, whatever characters it has, under either name.
odd="$work/it's in \$HOME"
for variable in prefix PREFIX; do
    sh -e -c "$(make_line install "$variable=${odd//\$/\$\$}")" > log
    [ -x "$odd/bin/mote" ] || fail "make install $variable=: nothing in $odd"
    rm -r "$odd"
done
grep -q "'/usr/local'" <<< "$(make_line install)" || fail "make install: not into /usr/local"

# What is installed is removed again, by a list, and nothing else: folders and files that were there stay,
# and so do those that came later.
mkdir -p "$work/system/usr/bin" "$work/system/usr/share/empty"
echo theirs > "$work/system/usr/bin/other"
(cd system && find . | sort) > before
for round in 1 2; do # the second time over the first
    DESTDIR=$work/system sh -e -c "$(make_line install prefix=/usr)" > log
done
[ -x system/usr/bin/mote ] && (cd system/usr && grep -v '/$' share/mote/installed.txt | xargs ls -d) > log ||
    fail "the list of what is installed names what is not there"
touch system/usr/share/mote/mine
/usr/bin/python3 -m compileall -q system/usr/lib/python3/dist-packages/mote > log || fail "the module for Python: $(cat log)"
uninstall_line=$(make_line uninstall prefix=/usr)
DESTDIR=$work/system sh -e -c "$uninstall_line"
[ -e system/usr/share/mote/mine ] || fail "make uninstall removed a file that it did not put there"
rm -r system/usr/share/mote
(cd system && find . | sort) > after
diff before after || fail "make uninstall left something, or removed what was there before"
! DESTDIR=$work/system sh -e -c "$uninstall_line" 2> log || fail "make uninstall twice"
grep -q "installed.txt is not there" log || fail "make uninstall where nothing is: $(cat log)"

# Staged below DESTDIR, then moved elsewhere: no file may contain the prefix.
DESTDIR=$work/stage sh -e -c "$(make_line install prefix=/opt/mote)" > log
[ "$(ls stage)" = opt ] || fail "files outside of DESTDIR/prefix"
mv stage/opt/mote moved
root=$work/moved
library=$root/$(basename "$(dirname "$(find "$root" -name libmote.a)")")
[ -e "$library/libmote.so" ] || library=$(dirname "$(find "$root" -name libmote.a)")
if grep -rlI -e /opt/mote -e "$work" "$root"; then fail "files above hold the place of installation"; fi

# An exported function of another library, or a private one of ours, would be a promise.
soname=$(objdump -p "$library/libmote.so" | awk '$1 == "SONAME" { print $2 }')
[[ $soname =~ ^libmote\.so\.[0-9.]+$ && -L $library/$soname ]] || fail "SONAME $soname"
nm -D --defined-only "$library/libmote.so" | awk '{ sub(/@.*/, "", $3); print $3 }' | sort > exported
while read -r symbol; do
    [[ $symbol == MOTE_* ]] || grep -qE "\b$symbol[([]" "$root"/include/mote/*.h ||
        fail "$symbol is exported, and in no public header"
done < exported
[ "$(grep -c ^mote_ exported)" -ge 40 ] || fail "few functions are exported"

headers=0
for header in "$root"/include/mote/*.h; do
    name=mote/$(basename "$header")
    echo "#include <$name>" > alone.c
    gcc -std=c17 -Wall -Wextra -Wstrict-prototypes -pedantic-errors -Werror -fsyntax-only \
        -I"$root/include" alone.c
    g++ -x c++ -std=c++11 -Wall -Wextra -pedantic-errors -Werror -fsyntax-only \
        -I"$root/include" alone.c
    headers=$((headers + 1))
done
echo "$headers headers compile alone, C17 and C++"

# The program of docs/extending.md: two octahedra 3 apart whose corners approach by 0.3 a frame.
"$tests/documented.sh" track.c > track.c
seq 8 | awk '{ printf "frame %d: distance %.9f\n", $1, 3 - 0.3 * $1 }' > expected
flags="-std=c17 -Wall -Wextra -pedantic-errors -Werror"
export PKG_CONFIG_PATH=$library/pkgconfig
# shellcheck disable=SC2046,SC2086 # lists of words
{
    cc $flags track.c $(pkg-config --cflags --libs mote) -o shared
    # The static library by its file name, followed by the libraries that it needs.
    cc $flags track.c $(pkg-config --cflags mote) $(pkg-config --static --libs mote |
        sed 's/-lmote/-l:libmote.a/') -o static
}
LD_LIBRARY_PATH=$library ./shared > out-shared
./static > out-static

# Programs that make skins, and a field with bounds of its own.
for source in "$tests"/../library/*.c; do
    name=$(basename "$source" .c)
    # shellcheck disable=SC2046,SC2086 # lists of words
    cc $flags "$source" $(pkg-config --cflags --libs mote) -lm -o "$name"
    LD_LIBRARY_PATH=$library "./$name" || fail "$name: another answer than expected"
done

# From C++ as well.
cat > use.cpp <<'CPP'
#include <mote/mote.h>
int main() { return mote_method_find("certified") && mote_error_text()[0] == 0 ? 0 : 1; }
CPP
# shellcheck disable=SC2046
c++ -std=c++17 -Wall -Wextra -Werror use.cpp $(pkg-config --cflags --libs mote) -o use
LD_LIBRARY_PATH=$library ./use || fail "a program in C++ finds no method"

mkdir package
cp track.c package
"$tests/documented.sh" CMakeLists.txt > package/CMakeLists.txt
cat >> package/CMakeLists.txt <<'CMAKE'
add_executable(track-static track.c)
target_link_libraries(track-static PRIVATE mote::mote_static)
CMAKE
cmake -S package -B package/build -DCMAKE_PREFIX_PATH="$root" -DCMAKE_C_STANDARD=17 \
    -DCMAKE_COMPILE_WARNING_AS_ERROR=ON > log
cmake --build package/build > log || { cat log; exit 1; }
package/build/track > out-package-shared
package/build/track-static > out-package-static
for way in shared static package-shared package-static; do
    cmp expected "out-$way" || fail "$way: another answer than expected"
done
for program in static package/build/track-static; do
    ! grep -q libmote <<< "$(ldd $program)" || fail "$program needs libmote.so"
done
for program in shared package/build/track; do
    grep -q "NEEDED *$soname" <<< "$(objdump -p $program)" || fail "$program does not ask for $soname"
done
echo "the program of docs/extending.md: pkg-config and find_package, shared and static, 8 frames as expected"
[ -e "$root/bin/mote" ] || fail "the program is not installed"
cited=$(sed -n 's/^version: //p' "$tests/../../CITATION.cff")
[ "mote $cited" = "$("$root/bin/mote" --version)" ] || fail "CITATION.cff names version $cited"

# Every file that a scenario names is there too.
find "$root/share/mote/datasets/scenarios" -name '*.json' | while read -r scenario; do
    grep -oE '"(\.\./)+[^"]+"' "$scenario" | tr -d '"' | sed "s|^|$(dirname "$scenario")/|" || true
done | sort -u > named
xargs -d '\n' ls -d < named > log || fail "a scenario names a file that is not installed"
[ "$(wc -l < named)" -ge 4 ] || fail "scenarios name few files"

# The installed program reads what was installed beside it.
echo '{"purpose": "of the installation", "like": "tt"}' > "$root/share/mote/datasets/scenarios/zz.json"
grep -q '^zz .*of the installation' <<< "$("$root/bin/mote" list scenarios)" || fail "scenarios of elsewhere"
"$root/bin/mote" run zz --frames 1-2 --replicates 1 --method certified --out run > log 2>&1 ||
    { cat log; fail "the installed program does not run"; }
"$root/bin/mote" check morph > log 2>&1 || { cat log; fail "a scenario of characters does not find its files"; }

# The engine of docs/extending.md, from the installed headers and program alone.
if pkg-config --exists ode; then
    for name in engine.c touch.json 'engine commands'; do "$tests/documented.sh" "$name" > "$name"; done
    for compiler in gcc clang; do
        command -v $compiler > log || continue
        # shellcheck disable=SC2046
        $compiler $flags -shared -fPIC engine.c $(pkg-config --cflags ode mote) -o engine.so $(pkg-config --libs ode)
        PATH=$root/bin:$PATH mote list methods --plugin ./engine.so > methods
        grep -q '^engine: ' methods || fail "$compiler: the library has no method"
    done
    PATH=$root/bin:$PATH bash -e 'engine commands' > table 2> log || { cat log; fail "the engine does not run"; }
    for row in engine certified fcl-aabb; do grep -q "^$row  *-  *[0-9]" table || fail "no row $row"; done
else
    echo "left out: ODE is not installed"
fi

commands=$("$root/bin/mote" --help | sed -n 's/^  mote \([a-z]*\).*/\1/p')
if command -v groff > log; then
    groff -man -ww -z "$root/share/man/man1/mote.1" 2> log
    [ ! -s log ] || { cat log; fail "warnings of the manual"; }
else
    echo "left out: groff is not installed"
fi
[ "$(wc -w <<< "$commands")" -ge 10 ] || fail "few commands: $commands"
for command in $commands; do
    grep -q "^\.B mote $command\b" "$root/share/man/man1/mote.1" ||
        fail "the manual does not tell of mote $command"
done

# complete WORD...: the completions offered for the last word.
source "$root/share/bash-completion/completions/mote"
compopt() { :; } # works in an interactive completion only
complete_words()
{
    COMP_WORDS=("$root/bin/mote" "$@")
    COMP_CWORD=$#
    _mote
    echo "${COMPREPLY[*]}"
}
[ "$(complete_words summ)" = summarize ] || fail "completion of a command"
[ "$(complete_words run --cache '')" = "hot evict" ] || fail "completion of a value"
[ "$(complete_words summarize DIR --format gb)" = gbench ] || fail "completion of a format"
[[ " $(complete_words run --r) " == *" --replicates "* ]] || fail "completion of an option"
[ "$(complete_words run zz)" = zz ] || fail "completion of a scenario"
[ "$(complete_words --al)" = --allow ] || fail "completion of an option before the command"
[ "$(complete_words --strict --allow /tmp summ)" = summarize ] || fail "completion of a command after options"
[ "$(complete_words --plugin lib.so run zz)" = zz ] || fail "completion of a scenario after options"
[ -z "$(complete_words --plugin ru)" ] || fail "completion of a library"
[[ " $(complete_words list --)" == *" --plugin" ]] || fail "completion of an option of every command"
[[ " $(complete_words race --) " == *" --plugin "* ]] || fail "completion of --plugin of race"
[ "$(complete_words run --method cert)" = certified ] || fail "completion of a method"
[ "$(complete_words list me)" = methods ] || fail "completion of a word"
echo "manual and completion know every command"
