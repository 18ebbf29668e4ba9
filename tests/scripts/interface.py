"""interface.py BUILD [accept]: what programs that use libmote rely on, against the list that is committed.

The list, tests/interface.txt, holds the functions of the installed headers with their types, structs with
their sizes, members and offsets, values of enumerations and constants, and the number in the library's name,
as gcc sees them. Anything of it that is gone or has changed fails; what is new is named. `accept` renews the
list. Each function must be in libmote.so, and each variable there must be named in docs/compatibility.md, where
it says why it is not promised. gcc, nm and readelf (binutils) are all that is needed."""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

LIST = Path(__file__).resolve().parent.parent / "interface.txt"
DOCUMENT = LIST.parent.parent / "docs/compatibility.md"
HEAD = """# What libmote promises (docs/compatibility.md). `make interface-accept` writes this list.
"""
BROKEN = """interface.py: the library no longer keeps what {list} promises: a program that was linked with the
released one may fail. Undo it, or, if a released version had it, raise MOTE_SOVERSION (cmake/MoteApi.cmake);
then renew the list with

    make interface-accept
"""


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True,
                          env={"LC_ALL": "C", "PATH": "/usr/local/bin:/usr/bin:/bin"}).stdout


def function_lines(declared):
    """Lines of gcc's -aux-info: those of inline functions have names, which are no promise. Definitions come
    last, so that what is declared and then defined in a header counts as inline."""
    lines = {}
    for line in declared.splitlines():
        found = re.match(r"/\* \S*/mote/\S+:\d+:N([CF]) \*/ (?:extern|static) (.*?(mote_\w+) \(.*\));", line)
        if not found:
            continue
        kind, text, name = found.groups()
        names = re.search(r"; /\* \(([\w, ]+)\)", line) if kind == "F" else None
        for parameter in names.group(1).split(", ") if names and names.group(1) != "void" else ():
            text = re.sub(rf"(?<=[ *]){parameter}(?=[,)\[])", "", text)
        text = re.sub(r" +(?=[,)])", "", text.replace(f"{name} (", f"{name}("))
        lines[name] = f"{'inline' if kind == 'F' else 'function'} {name}: {text}"
    return lines.values()


def constant_lines(macros):
    """Constants; macros with parameters, guards of headers and what is built of other names are no part."""
    for line in macros.splitlines():
        found = re.match(r"#define (MOTE_\w+) (\(?-?[0-9].*)$", line)
        if found:
            yield f"constant {found[1]}: {found[2]}"


class Debug:
    """The types in readelf's text of .debug_info, by offset."""

    def __init__(self, text):
        self.entries = {}
        path = []
        for line in text.splitlines():
            head = re.match(r" <(\d+)><([0-9a-f]+)>: Abbrev Number: \d+ \(DW_TAG_(\w+)\)", line)
            if head:
                depth = int(head[1])
                self.entry = {"tag": head[3], "children": []}
                self.entries[head[2]] = self.entry
                del path[depth:]
                if path:
                    path[-1]["children"].append(self.entry)
                path.append(self.entry)
                continue
            value = re.match(r"    <[0-9a-f]+>   DW_AT_(\w+) *: (?:\(.*?\)[: ]+)?(?:\(.*offset.*\): )?(.*)", line)
            if value:
                self.entry.setdefault(value[1], value[2].split("): ")[-1].strip())

    def type_of(self, entry):
        target = entry.get("type")
        return self.text_of(self.entries[target.strip("<>").removeprefix("0x")]) if target else "void"

    def text_of(self, entry):
        tag = entry["tag"]
        if "name" in entry:
            return entry["name"]
        if tag == "pointer_type":
            return f"{self.type_of(entry)} *"
        if tag == "const_type":
            target = self.type_of(entry)
            return f"{target}const" if target.endswith("*") else f"const {target}"
        if tag == "restrict_type":
            return f"{self.type_of(entry)} restrict"
        if tag == "array_type":
            sizes = (int(child["upper_bound"], 0) + 1 if "upper_bound" in child else 0
                     for child in entry["children"])
            return self.type_of(entry) + "".join(f"[{size}]" for size in sizes)
        if tag == "subroutine_type":
            parameters = ", ".join(self.type_of(child) if "type" in child else "..." for child in entry["children"])
            return f"{self.type_of(entry)} ({parameters or 'void'})"
        if tag in ("structure_type", "union_type"):
            members = "; ".join(f"{self.type_of(child)} {child.get('name', '')}" for child in entry["children"])
            return f"{tag.split('_')[0]} {{{members}}}"
        return tag

    def lines(self):
        for entry in self.entries.values():
            name, tag = entry.get("name", ""), entry["tag"]
            if tag == "enumerator" and name.startswith("MOTE_"):
                yield f"value {name}: {entry['const_value']}"
            elif tag == "typedef" and name.startswith("mote_"):
                target = self.type_of(entry)
                if target != name:
                    yield f"type {name}: {target}"
            elif tag == "structure_type" and name.startswith("mote_") and "byte_size" in entry:
                yield f"struct {name}: {int(entry['byte_size'], 0)} bytes"
                for member in entry["children"]:
                    place = int(member.get("data_member_location", "0"), 0)
                    yield f"member {name}.{member.get('name', '')}: at {place}, {self.type_of(member)}"


def interface_lines(build):
    with tempfile.TemporaryDirectory() as folder:
        source, declared, made = (f"{folder}/{name}" for name in ("all.c", "declared", "all.o"))
        Path(source).write_text("#include <mote/mote.h>\n")
        include = f"-I{build}/include"
        run("gcc", "-std=c17", "-g", "-fno-eliminate-unused-debug-types", "-aux-info", declared, include,
            "-c", source, "-o", made)
        lines = set(function_lines(Path(declared).read_text()))
        lines |= set(constant_lines(run("gcc", "-std=c17", "-dM", "-E", include, source)))
        lines |= set(Debug(run("readelf", "--debug-dump=info", made)).lines())
    soname = re.search(r"Library soname: \[(.*)\]", run("readelf", "-d", f"{build}/libmote.so"))
    return sorted(lines | {f"library {soname[1]}: SONAME"})


def exports(build):
    """Of each name that libmote.so exports, nm's letter for what it is."""
    lines = run("nm", "-D", "--defined-only", f"{build}/libmote.so").splitlines()
    return {line.split()[-1].split("@")[0]: line.split()[-2] for line in lines}


def missing_functions(exported, lines):
    declared = {line.split()[1].rstrip(":") for line in lines if line.startswith("function ")}
    return sorted(declared - exported.keys())


def unnamed_variables(exported):
    named = set(re.findall(r"`(mote_\w+)`", DOCUMENT.read_text()))
    return sorted(name for name, kind in exported.items() if kind in "BDGRSV" and name not in named)


def compare(listed, lines):
    """Prints what is gone or other than listed, and what is new; true if nothing promised is broken."""
    now = {line.split(": ")[0]: line for line in lines}
    gone = [line for line in listed if line not in set(lines)]
    for line in gone:
        key, said = line.split(": ", 1)
        new = now[key].split(": ", 1)[1] if key in now else None
        print(f"{key} was: {said}; now: {new}" if new else f"{key} is gone; it was: {said}", file=sys.stderr)
    new = sorted(set(now) - {line.split(": ")[0] for line in listed})
    if new:
        print(f"{len(new)} not in {LIST.name} yet; `make interface-accept` adds them: {', '.join(new)}")
    return not gone


def main():
    build = Path(sys.argv[1]).resolve()
    lines = interface_lines(build)
    exported = exports(build)
    missing = missing_functions(exported, lines)
    if missing:
        return f"interface.py: in a public header, but not in libmote.so: {', '.join(missing)}"
    unnamed = unnamed_variables(exported)
    if unnamed:
        return (f"interface.py: libmote.so exports variables that {DOCUMENT.name} does not name: {', '.join(unnamed)}; "
                "make them functions, or name them there")
    if sys.argv[2:] == ["accept"]:
        LIST.write_text(HEAD + "\n".join(lines) + "\n")
        return print(f"{LIST.name}: {len(lines)} lines")
    listed = [line for line in LIST.read_text().splitlines() if not line.startswith("#")]
    if not compare(listed, lines):
        return BROKEN.format(list=LIST.name)
    print(f"libmote keeps all of the {len(listed)} lines of {LIST.name}")


if __name__ == "__main__":
    sys.exit(main())
