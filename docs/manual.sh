#!/bin/sh
# manual.sh MOTE OUT: writes mote(1) from mote.1.in, with the commands as `MOTE --help` tells them:
# two blanks and "mote COMMAND ...", goes on with eleven blanks; eight blanks and what it does.
set -eu
folder=$(dirname "$0")
version=$("$1" --version | cut -d ' ' -f 2)
"$1" --help | sed 's/\\/\\e/g; s/-/\\-/g' | awk '
    /^  mote / { if (usage != "") flush(); usage = substr($0, 3); text = ""; next }
    /^           / { if (usage != "" && text == "") { sub(/^ +/, ""); usage = usage " " $0; next } }
    /^        / { sub(/^ +/, ""); text = text == "" ? $0 : text " " $0; next }
    { if (usage != "") flush(); usage = "" }
    function flush() { print ".TP\n.B " usage "\n" text; usage = "" }
    END { if (usage != "") flush() }' > "$2.commands"
sed -e "s/@VERSION@/$version/" -e "/@COMMANDS@/r $2.commands" -e '/@COMMANDS@/d' \
    "$folder/mote.1.in" > "$2.part"
rm "$2.commands"
mv "$2.part" "$2"
