"""Mutation: does a test fail when the code is wrong?

  mutate.py BUILD OUT [--module NAME] [--files GLOB] [--count N] [--seed S] [--jobs J]

Makes small changes in the files of each module, one at a time: another comparison or operator,
another constant, a condition negated, a statement left out, two arguments swapped. Each mutant
is compiled by itself, linked into those tests of its module from BUILD (a release build) that
execute its line, and run. A mutant is killed when a test fails, crashes or takes much longer than it
should. One that only the half minute of all answers (tests/studies/answers.c) would find counts as a survivor.
Those that do not compile, or compile to the very code of the original, are none; nor is <= in place
of < where the larger or smaller of two values is taken. A seeded sample of
N (120) of each module is tried. --part: of all mutants in M samples that have none in common, the Kth.

Mutants that change no answer that the headers promise are listed in
tests/mutants_equivalent.txt with the reason; they count neither way. OUT/mutation.json: a list of
{module, mutants, killed, equivalent, score, survivors}; OUT/mutation.md: the table; OUT/mutation.tsv:
{module, mutants, killed, equivalent}; OUT/survivors.txt: {file:line, mutant}. Of a part, the last two
are mutation-K.tsv and survivors-K.txt. The exit status is 1 where a score is below the target; a
part is not judged by its score.
"""
import argparse
import collections
import concurrent.futures
import fnmatch
import functools
import glob
import hashlib
import json
import os
import random
import re
import resource
import shlex
import subprocess
import sys
import tempfile

TARGET = 0.85
EQUIVALENT = "tests/mutants_equivalent.txt"

# Files, and their tests. Of each file's tests those come first that find most in the least time.
MODULES = {
    "triangle": ("core/body/triangle*.c", ["test_triangle_bounds", "few answers", "test_triangle"]),
    "statistics": ("harness/base/statistics*.c", ["test_statistics", "test_statistics_tests",
                                              "test_statistics_holm", "test_statistics_intervals"]),
    "certificate": (
        "core/certificate/*.c",
        ["test_certificate_bounds", "test_certificate_box", "test_certificate_split",
         "test_certificate", "tt answers", "ww answers", "hands answers", "test_certificate_fitted",
         "test_allocations", "test_certificate_limits", "test_certificate_apart", "test_pair_list",
         "test_scene_sift", "test_scene", "few answers"],
    ),
    "stream": (
        "core/stream/*.c",
        ["few answers", "test_stream_tree", "test_stream_boxes", "test_stream_leaf", "test_stream",
         "test_stream_limits", "test_stream_scene", "test_stream_batch", "test_method_auto",
         "test_allocations_impact"],
    ),
    "skin": (
        "core/skin/*.c",
        ["test_skin_create", "test_skin_positions", "few answers", "test_skin_bounds",
         "test_skin"],
    ),
}
# They count what is allocated, by functions in place of libc's, and so cannot look for leaks.
COUNTS_HEAP = {"test_certificate_limits", "test_allocations", "test_allocations_impact", "test_scene"}
HEAP_COUNT = "harness/base/heap_count.c"
CHECK = ["--check", "tests/answers.txt"]
ARGUMENTS = {f"{name} answers": ["--scenario", name] + CHECK for name in ("tt", "ww", "hands")}
ARGUMENTS["few answers"] = ["--few"] + CHECK
# Less than half the time of the default linker; and libraries that a test does not use take longer to load than
# most tests take to run.
QUICK_LINK = ["-fuse-ld=gold", "-Wl,--as-needed"]

TOKEN = re.compile(
    r"""(?P<space>\s+)
      |(?P<comment>/\*.*?\*/|//[^\n]*)
      |(?P<string>"(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])*')
      |(?P<number>0[xX][0-9a-fA-F.]+(?:[pP][+-]?\d+)?[uUlLfF]*
                 |(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?[uUlLfF]*)
      |(?P<word>[A-Za-z_]\w*)
      |(?P<mark><<=|>>=|->|\+\+|--|<=|>=|==|!=|&&|\|\||<<|>>|[-+*/%&|^]=|.)""",
    re.X | re.S,
)

KEYWORDS = set("if else for while do switch case return sizeof const static inline struct enum "
               "union void double float int char bool unsigned long typedef goto default".split())
OTHER_MARK = {
    "<": ["<=", ">"], ">": [">=", "<"], "<=": ["<", ">"], ">=": [">", "<"],
    "==": ["!="], "!=": ["=="], "&&": ["||"], "||": ["&&"],
    "+": ["-"], "-": ["+"], "*": ["/"], "/": ["*"], "%": ["*"],
    "+=": ["-="], "-=": ["+="], "*=": ["/="], "/=": ["*="], "++": ["--"], "--": ["++"],
    "&": ["|"], "|": ["&"], "<<": [">>"], ">>": ["<<"],
}
OTHER_WORD = {
    "fmin": ["fmax"], "fmax": ["fmin"], "true": ["false"], "false": ["true"],
    "break": ["continue"], "continue": ["break"],
}
# Symmetric in their arguments.
SYMMETRIC = {"mote_dot", "mote_add", "mote_distance_squared", "fmin", "fmax", "max2", "fminf",
             "fmaxf", "mote_dot_lanes", "memcpy", "calloc", "mote_allocate"}


class Mutant:
    def __init__(self, path, line, kind, start, end, text, source):
        self.path, self.line, self.kind = path, line, kind
        self.start, self.end, self.text = start, end, text
        from_line = source.rfind("\n", 0, start) + 1
        to_line = source.find("\n", end)
        squeeze = lambda s: " ".join(s.split())
        self.before = squeeze(source[from_line:to_line])
        self.after = squeeze(source[from_line:start] + text + source[end:to_line])
        self.killed_by = None
        self.last_line = line + source.count("\n", start, end)

    def name(self):
        return f"{self.path}: {self.before} => {self.after}"


def tokens_of(source):
    found = []
    for match in TOKEN.finditer(source):
        kind = match.lastgroup
        if kind not in ("space", "comment"):
            found.append((kind, match.group(), match.start(), match.end()))
    return found


def close_of(tokens, at):
    """The index of the bracket that closes the one at `at`."""
    depth = 0
    for k in range(at, len(tokens)):
        if tokens[k][1] in ("(", "[", "{"):
            depth += 1
        elif tokens[k][1] in (")", "]", "}"):
            depth -= 1
            if depth == 0:
                return k
    return len(tokens) - 1


def is_operand_end(token):
    return token[0] == "number" or token[1] in (")", "]") or (
        token[0] == "word" and token[1] not in KEYWORDS)


def other_numbers(text):
    if text in ("0", "0u", "0.0"):
        return ["1"]
    if text in ("1", "1u", "1.0"):
        return ["0", "2"]
    return [f"(2 * {text})", "0"]


def is_length(tokens, at):
    """Whether the number at `at` is the length of an array that is declared."""
    if tokens[at - 1][1] != "[" or tokens[at + 1][1] != "]":
        return False
    name = at - 1
    while tokens[name][1] in ("[", "]") or tokens[name + 1][1] == "]":
        name -= 1
    declared = tokens[name - 1]
    return tokens[name][0] == declared[0] == "word" and declared[1] not in ("return", "sizeof")


def words_until(tokens, at, ends):
    """The texts from `at` to before one of the marks, outside of brackets, and where that is."""
    words = []
    while at < len(tokens) and tokens[at][1] not in ends + (")", "]", "}", ";"):
        end = close_of(tokens, at) + 1 if tokens[at][1] in ("(", "[") else at + 1
        words += [token[1] for token in tokens[at:end]]
        at = end
    return words, at


def takes_extreme(tokens, k):
    """Whether the comparison at k is that of A < B ? A : B, or ? B : A: where both are equal, either
    gives their value."""
    right, question = words_until(tokens, k + 1, ("?", ","))
    if question == len(tokens) or tokens[question][1] != "?":
        return False
    first, colon = words_until(tokens, question + 1, (":",))
    second, _ = words_until(tokens, colon + 1, (",",))
    left = second if first == right else first
    if right not in (first, second) or left == right:
        return False
    start = k - len(left)
    return (start > 0 and [token[1] for token in tokens[start:k]] == left and
            tokens[start - 1][1] in ("=", "(", ",", "?", ":", "return"))


def split_arguments(tokens, at, end):
    """The arguments of the call whose bracket is at `at`: pairs of positions in the source."""
    parts, depth, first = [], 0, at + 1
    for k in range(at + 1, end + 1):
        if tokens[k][1] in ("(", "[", "{"):
            depth += 1
        if k == end or (depth == 0 and tokens[k][1] == ","):
            if k > first:
                parts.append((tokens[first][2], tokens[k - 1][3]))
            first = k + 1
        if tokens[k][1] in (")", "]", "}"):
            depth -= 1
    return parts


def statement_end(tokens, at):
    """The index of the semicolon of an expression statement at `at`; None: it is none."""
    if tokens[at][0] != "word" and tokens[at][1] not in ("*", "++", "--", "("):
        return None
    if tokens[at][1] in KEYWORDS or tokens[at][1] in ("break", "continue"):
        return None
    following = tokens[at + 1]
    if following[0] == "word" or (following[1] == "*" and tokens[at][0] == "word"):
        return None  # a declaration
    k = at
    while k < len(tokens) and tokens[k][1] != ";":
        if tokens[k][1] in ("{", "}"):
            return None
        k = close_of(tokens, k) + 1 if tokens[k][1] in ("(", "[") else k + 1
    return k


def mutants_of(path):
    source = open(path).read()
    tokens = tokens_of(source)
    found = []
    line_of = lambda position: source.count("\n", 0, position) + 1
    directive = {number + 1 for number, text in enumerate(source.split("\n"))
                 if re.match(r"\s*#(?!\s*define\s+\w+\s+[^\\]*$)", text)}
    depth = brackets = 0

    def add(kind, start, end, text):
        if line_of(start) not in directive:
            found.append(Mutant(path, line_of(start), kind, start, end, text, source))

    for k, (kind, text, start, end) in enumerate(tokens):
        before = tokens[k - 1] if k else ("mark", ";", 0, 0)
        after = tokens[k + 1] if k + 1 < len(tokens) else ("mark", ";", 0, 0)
        in_define = source[source.rfind("\n", 0, start) + 1:start].lstrip().startswith("#define")
        depth += (text == "{") - (text == "}")
        brackets += (text in "([") - (text in ")]")
        if kind == "number" and (depth > 0 or in_define):
            for other in other_numbers(text):
                if other == "0" or not is_length(tokens, k):  # more room changes no answer
                    add("constant", start, end, other)
        if depth == 0:
            continue
        if kind == "mark" and text in OTHER_MARK:
            unary = text in "+-*&" and not is_operand_end(before)
            if text == "-" and unary:
                add("sign", start, end, "")
            elif not unary:
                extreme = text[0] in "<>" and takes_extreme(tokens, k)
                for other in OTHER_MARK[text]:
                    if not (extreme and other[0] == text[0]):
                        add("operator", start, end, other)
        if kind == "word" and text in OTHER_WORD:
            for other in OTHER_WORD[text]:
                add("word", start, end, other)
        if text in ("if", "while") and after[1] == "(":
            stop = close_of(tokens, k + 1)
            add("condition", after[2], tokens[stop][3],
                f"(!{source[after[2]:tokens[stop][3]]})")
        if kind == "word" and after[1] == "(" and text not in KEYWORDS | SYMMETRIC:
            parts = split_arguments(tokens, k + 1, close_of(tokens, k + 1))
            for one, two in zip(parts, parts[1:]):
                add("arguments", one[0], two[1], source[two[0]:two[1]] +
                    source[one[1]:two[0]] + source[one[0]:one[1]])
        if brackets == 0 and before[1] in (";", "{", "}", ")", "else"):
            stop = statement_end(tokens, k)
            if stop is not None and stop > k:
                add("statement", start, tokens[stop][2], "")
    return found


@functools.cache
def commands_of(build):
    """How the build compiles each of its files: entries of compile_commands.json."""
    if not os.path.exists(f"{build}/compile_commands.json"):
        sys.exit(f"mutate: {build} has no compile_commands.json; make build-tests makes it")
    return {os.path.realpath(entry["file"]): entry
            for entry in json.load(open(f"{build}/compile_commands.json"))}


def files_of(build, pattern):
    """The files that match and are compiled: plain.c is for a core without other libraries."""
    return [p for p in sorted(glob.glob(pattern)) if os.path.realpath(p) in commands_of(build)]


def compile_command(build, path):
    entry = commands_of(build).get(os.path.realpath(path))
    if entry is None:
        sys.exit(f"mutate: {path} is not compiled in {build}")
    kept, skip = [], False
    for word in shlex.split(entry["command"]):
        if skip or word in ("ccache", "-c") or word.endswith("/ccache"):
            skip = False
        elif word == "-o":
            skip = True
        elif not (word.startswith(("-DMOTE_HAVE_CLONES", "-Werror", "-O", "-W", "-g")) or
                  word.endswith(path)):
            kept.append(word)
    # Arguments of another type do not make mutants; warnings are discarded.
    strict = [f"-Werror={name}" for name in ("incompatible-pointer-types", "int-conversion",
                                             "discarded-qualifiers", "return-type")]
    return kept + ["-O1"] + strict, entry["directory"]


def program_of(test):
    return test.split()[-1]


def link_command(build, test):
    """Words and folder of the command that links a test."""
    text = f"{build}/tests/CMakeFiles/{test}.dir/link.txt"
    if os.path.exists(text):
        return shlex.split(open(text).read()), f"{build}/tests"
    lines = subprocess.run(["ninja", "-C", build, "-t", "commands", f"tests/{test}"],
                           capture_output=True, text=True, check=True).stdout.strip()
    words = shlex.split(lines.split("\n")[-1])
    return [w for w in words if w not in (":", "&&")], build


def check_tests(build):
    """Ends the program if a module names a test that the build does not have."""
    for module, (_, tests) in MODULES.items():
        for test in tests:
            if not os.path.exists(f"{build}/tests/{program_of(test)}"):
                sys.exit(f"mutate: {build}/tests has no {program_of(test)}, which {module} names")


def children_seconds():
    """What all programs that were run took of a processor."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def limits(seconds):
    def set_limits():
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 1))
        resource.setrlimit(resource.RLIMIT_DATA, (4 << 30, 4 << 30))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    return set_limits


class Bench:
    """Compiles, links and runs mutants of one module."""

    def __init__(self, build, work, tests):
        self.build, self.work, self.tests = os.path.abspath(build), work, tests
        self.source_dir = os.getcwd()
        self.links = {test: link_command(self.build, program_of(test)) for test in tests}
        self.seconds, self.costs, self.originals, self.executed = {}, {}, {}, {}
        self.tried, self.killed = collections.Counter(), collections.Counter()  # by test, and by file and test
        # In the place of the harness's own: that one replaces the functions that the leak check does.
        self.uncounted = f"{work}/uncounted.o"
        self.compile_file(HEAP_COUNT, self.uncounted, ["-D__SANITIZE_ADDRESS__"])

    def compile_file(self, path, made, flags):
        words, directory = compile_command(self.build, path)
        subprocess.run(words + [*flags, "-c", "-o", made, f"{self.source_dir}/{path}"], cwd=directory, check=True)

    def compile(self, path, source, folder):
        """The object of a file with this text; None where it does not compile."""
        words, directory = compile_command(self.build, path)
        # The text comes by standard input, so no source file is written.
        made = f"{folder}/mutant.o"
        result = subprocess.run(
            words + [f"-I{self.source_dir}", "-x", "c", "-c", "-o", made, "-"], cwd=directory,
            input=source.encode(), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return made if result.returncode == 0 else None

    def link(self, test, made, folder, flags=()):
        """The program of a test with these objects, a list, in the place of its own."""
        program = f"{folder}/{program_of(test)}"
        if os.path.exists(program):
            return program
        words, directory = self.links[test]
        words = list(words)
        words[words.index("-o") + 1] = program
        first = next(k for k, w in enumerate(words) if w.endswith(".o"))
        words[first:first] = QUICK_LINK + [*flags, *made]
        if test not in COUNTS_HEAP:
            words[first:first] = [self.uncounted, "-fsanitize=leak"]
        result = subprocess.run(words, cwd=directory, capture_output=True, text=True)
        if result.returncode != 0:
            sys.exit(f"mutate: {test} does not link: {result.stderr[-500:]}")
        return program

    def run(self, program, test, folder, seconds):
        """Exit status; None when it took too long."""
        try:
            return subprocess.run([program] + ARGUMENTS.get(test, []), stdout=subprocess.DEVNULL,
                                  stderr=subprocess.DEVNULL, preexec_fn=limits(seconds),
                                  timeout=60 * seconds, cwd=self.source_dir,
                                  env=dict(os.environ, TMPDIR=folder)).returncode
        except subprocess.TimeoutExpired:
            return None

    def prepare(self, paths):
        """The originals: their objects' texts, and how long the tests take with them."""
        folder = tempfile.mkdtemp(dir=self.work)
        for path in paths:
            made = self.compile(path, open(path).read(), folder)
            if made is None:
                sys.exit(f"mutate: {path} does not compile")
            self.originals[path] = code_of(made)
        for test in self.tests:
            begin = children_seconds()
            program = self.link(test, [made], folder)
            linked = children_seconds()
            if self.run(program, test, folder, 600) != 0:
                sys.exit(f"mutate: {test} fails without a mutant")
            self.costs[test] = children_seconds() - begin
            self.seconds[test] = int(4 * (children_seconds() - linked) + 3)
        self.count_lines(paths)

    def count_lines(self, paths):
        """How often each test executes each line of the files."""
        folder = tempfile.mkdtemp(dir=self.work)
        made = [f"{folder}/{os.path.basename(path)[:-2]}.o" for path in paths]
        for path, name in zip(paths, made):
            self.compile_file(path, name, ["-O0", "--coverage"])
        for test in self.tests:
            if self.run(self.link(test, made, folder, ["--coverage"]), test, folder, 600) != 0:
                sys.exit(f"mutate: {test} fails when its lines are counted")
            self.executed[test] = {path: lines_of(name) for path, name in zip(paths, made)}

    def gain(self, path, test):
        """How many mutants of this file a test is expected to kill a second, by those that it was run on."""
        overall = (1 + self.killed[test]) / (2 + self.tried[test])
        of_file = (overall + self.killed[path, test]) / (1 + self.tried[path, test])
        return of_file / self.costs[test]

    def reaches(self, test, mutant):
        """Whether the test may notice the mutant: not if it executes none of its lines. A label is no such
        line, nor is one that gcov does not count, such as a constant's."""
        count = self.executed[test][mutant.path]
        lines = range(mutant.line, mutant.last_line + 1)
        return "case " in mutant.before or any(count.get(line, 1) for line in lines)

    def kills(self, test, mutant, made, folder):
        program = self.link(test, [made], folder)
        killed = self.run(program, test, folder, self.seconds[test]) != 0
        for key in test, (mutant.path, test):
            self.tried[key] += 1
            self.killed[key] += killed
        return killed

    def try_one(self, mutant):
        """'killed by TEST', 'survived', 'none': no mutant."""
        source = open(mutant.path).read()
        text = source[:mutant.start] + mutant.text + source[mutant.end:]
        with tempfile.TemporaryDirectory(dir=self.work) as folder:
            made = self.compile(mutant.path, text, folder)
            if made is None or code_of(made) == self.originals[mutant.path]:
                return "none"
            for test in sorted(self.tests, key=lambda test: -self.gain(mutant.path, test)):
                if self.reaches(test, mutant) and self.kills(test, mutant, made, folder):
                    return f"killed by {test}"
        return "survived"


def code_of(made):
    """A hash of what an object holds, its name and notes aside."""
    text = subprocess.run(["objdump", "-d", "-r", "-s", "-j", ".text", "-j", ".rodata", "-j",
                           ".rodata.cst8", "-j", ".rodata.cst16", "-j", ".data.rel.ro.local",
                           made], capture_output=True).stdout
    return hashlib.sha256(text[text.find(b"\n", text.find(b"file format")):]).hexdigest()


def lines_of(made):
    """How often each line of a file was executed since the last call, by number; {}: not counted."""
    counts = collections.Counter()
    name = made[:-2]
    if os.path.exists(f"{name}.gcda"):
        text = subprocess.run(["gcov", "--json-format", "--stdout", made], cwd=os.path.dirname(made),
                              capture_output=True, check=True).stdout
        os.remove(f"{name}.gcda")
        for file in json.loads(text)["files"]:
            if os.path.basename(file["file"]) == f"{os.path.basename(name)}.c":
                for line in file["lines"]:
                    counts[line["line_number"]] += line["count"]
    return counts


def read_equivalents():
    if not os.path.exists(EQUIVALENT):
        return set()
    lines = [line.strip() for line in open(EQUIVALENT)]
    return {line for line in lines if line and not line.startswith("#")}


def study(module, arguments):
    pattern, tests = MODULES[module]
    paths = [p for p in files_of(arguments.build, pattern) if fnmatch.fnmatch(p, arguments.files)]
    if not paths:
        return None
    mutants = [m for path in paths for m in mutants_of(path)]
    random.Random(arguments.seed).shuffle(mutants)
    wanted = arguments.count
    if arguments.part:
        part, parts = arguments.part
        mutants = mutants[part - 1::parts]
        wanted = len(mutants)
    equivalents = read_equivalents()
    counted, killed, known, survivors = 0, 0, 0, []
    with tempfile.TemporaryDirectory(prefix="mote-mutants-") as work:
        bench = Bench(arguments.build, work, tests)
        bench.prepare(paths)
        left = iter(mutants)
        with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
            while counted < wanted:
                batch = [m for m, _ in zip(left, range(wanted - counted))]
                if not batch:
                    break
                for mutant, outcome in zip(batch, pool.map(bench.try_one, batch)):
                    if outcome == "none":
                        continue
                    counted += 1
                    same = mutant.name() in equivalents
                    killed += outcome != "survived"
                    known += outcome == "survived" and same
                    if outcome == "survived" and not same:
                        survivors.append(mutant)
                    if outcome != "survived" and same:
                        print(f"listed as equivalent, but {outcome}: {mutant.name()}")
                    print(f"{mutant.path}:{mutant.line}: {mutant.kind}: {outcome}"
                          f"{' (equivalent)' if outcome == 'survived' and same else ''}",
                          file=arguments.log, flush=True)
    for mutant in survivors:
        print(f"survived: {mutant.path}:{mutant.line}: {mutant.before} => {mutant.after}")
    return {"module": module, "files": len(paths), "possible": len(mutants), "mutants": counted,
            "killed": killed, "equivalent": known,
            "score": round(killed / (counted - known), 4) if counted > known else None,
            "survivors": [{"file": m.path, "line": m.line, "kind": m.kind, "from": m.before,
                           "to": m.after} for m in survivors]}


def part_of(text):
    """K/M as two numbers."""
    match = re.fullmatch(r"([1-9]\d*)/([1-9]\d*)", text)
    if not match or int(match[1]) > int(match[2]):
        raise argparse.ArgumentTypeError(f"{text}: write K/M, such as 2/10: the second of ten parts")
    return int(match[1]), int(match[2])


def write_lines(path, lines):
    with open(path, "w") as file:
        file.writelines(f"{line}\n" for line in lines)


def main():
    parser = argparse.ArgumentParser(description="mutation of some modules; see the file's head")
    parser.add_argument("build")
    parser.add_argument("out")
    parser.add_argument("--module", choices=sorted(MODULES), action="append")
    parser.add_argument("--files", default="*")
    parser.add_argument("--count", type=int, default=120)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--part", type=part_of)
    parser.add_argument("--list", action="store_true", help="only list what could be tried")
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    if arguments.list:
        for module in arguments.module or MODULES:
            for path in files_of(arguments.build, MODULES[module][0]):
                for m in mutants_of(path):
                    print(f"{m.path}:{m.line}: {m.kind}: {m.before} => {m.after}")
        return 0
    check_tests(arguments.build)
    results = []
    with open(f"{arguments.out}/mutants.log", "w") as log:
        arguments.log = log
        for module in arguments.module or MODULES:
            result = study(module, arguments)
            if result:
                results.append(result)
    if not any(r["mutants"] for r in results):
        sys.exit(f"mutate: nothing to change in {arguments.files}")
    with open(f"{arguments.out}/mutation.json", "w") as file:
        json.dump(results, file, indent=2)
        file.write("\n")
    of_part = f"-{arguments.part[0]}" if arguments.part else ""
    write_lines(f"{arguments.out}/mutation{of_part}.tsv",
                [f"{r['module']}\t{r['mutants']}\t{r['killed']}\t{r['equivalent']}" for r in results])
    write_lines(f"{arguments.out}/survivors{of_part}.txt",
                [f"{s['file']}:{s['line']}\t{s['from']} => {s['to']}" for r in results for s in r["survivors"]])
    table = ["| module | mutants | killed | equivalent | score |",
             "| --- | ---: | ---: | ---: | ---: |"]
    for r in results:
        score = "" if r["score"] is None else f"{100 * r['score']:.1f} %"
        table.append(f"| {r['module']} | {r['mutants']} | {r['killed']} | {r['equivalent']} | "
                     f"{score} |")
    text = "\n".join(table) + "\n"
    with open(f"{arguments.out}/mutation.md", "w") as file:
        file.write(text)
    print(text, end="")
    return 0 if arguments.part or all(r["score"] and r["score"] >= TARGET for r in results) else 1


if __name__ == "__main__":
    sys.exit(main())
