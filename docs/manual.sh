#!/bin/sh
# manual.sh MOTE OUT: writes mote(1) from mote.1.in, with the commands and options as
# `MOTE --help-table` tells them: lines of "command", name, arguments, summary, each followed by
# lines of "option", name, value, help; tabs between them.
set -eu
folder=$(dirname "$0")
version=$("$1" --version | cut -d ' ' -f 2)
"$1" --help-table | sed 's/\\/\\e/g; s/-/\\-/g' | awk -F '\t' '
    $1 == "command" {
        if (inside) print ".RE"
        print ".TP\n.B mote " $2 ($3 == "" ? "" : " " $3) "\n" $4
        inside = 0
    }
    $1 == "option" {
        if (!inside) print ".RS"
        inside = 1
        print ".TP\n.B " $2 ($3 == "" ? "" : " " $3) "\n" $4
    }
    END { if (inside) print ".RE" }' > "$2.commands"
sed -e "s/@VERSION@/$version/" -e "/@COMMANDS@/r $2.commands" -e '/@COMMANDS@/d' \
    "$folder/mote.1.in" > "$2.part"
rm "$2.commands"
mv "$2.part" "$2"
