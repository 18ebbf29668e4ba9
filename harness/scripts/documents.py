#!/usr/bin/python3
"""documents.py ROOT [--check]: numbers in documents come from stored results.

A table between the lines "<!-- from SOURCE -->" and "<!-- to here -->" of a document is written again (make
documents). SOURCE is a file of the accepted reference (reference/summary.json), or STUDY/FILE: that of the newest
record of a study of `make record`, or, while there is none, FILE in results/reference; what follows a "#" is one of
several tables of the same file; checks, fuzz, coverage, mutation and soak are those of reliability_tables.py. Above the
table stands when it was measured, and whether the study's sources have changed since. A number within a sentence is
typed by hand; the sentence stands in SENTENCES with its values, and has to be in the document, rounded as there.
--check writes nothing, and says what disagrees. Status: 0 all agree, 1 something disagrees, 4 a file is missing or cannot be read."""
import functools
import json
import os
import re
import sys
from pathlib import Path

sys.dont_write_bytecode = True  # no folder beside the sources
from character_tables import CHARACTERS, PARTS, characters, characters_table, exact_to_parts, parts_table
from engine_tables import ENGINES, PEERS, engines_table, is_tree, ode_to_fcl, peers_tables, times
from impact_tables import (DYNAMICS, FCL_SPEED, LONG_STEPS, SHORT_STEPS, SPEED, continuous_to_sampled, fcl_table, impact_table,
                           long_questions, long_steps_table, short_steps_table, sums)
from number_text import digits, exact_text, interval, percent, power, size, span
from records import by_method, csv_rows, file_of, has_changed, is_right, record_of, study_of
from reliability_tables import GATHERED, checks, furthest_off, soaked
from tune_tables import TUNE, count_of_settings, fastest_not_asked, oriented_to_boxes, tune_table
from verdict_tables import LARGE_VERDICTS, VERDICTS, convex, invented, oriented_bottom_up, verdicts_table

SUMMARY = "reference/summary.json"
CLAIMS = "claims/claims.json"
BODIES = "bodies/bodies.csv"
CROWDS = "bodies/characters-summary.csv"
BENCH = "bench/summary.csv"
EXTREMES = "extremes/extremes.json"
RATIOS = "ratios/ratios.txt"
AUTO = "auto/auto.txt"
ABLATION = "ablation/summary.csv"
INGREDIENTS = "ingredients/summary.csv"
READERS = "readers/readers.md"
ANIMATED = "readers/characters.txt"
PYTHON = "python-speed/python-speed.txt"
RACES = "reference/races.csv"
END = "<!-- to here -->"
CHANGED = "its sources have changed since"


def link(text, record, document):
    return f"[{text}]({os.path.relpath(record, document.parent)})"


def heading(root, source, document, old):
    """When a table was measured. old: the block as it stands, which is believed where nothing else tells."""
    source = source.partition("#")[0]
    if source.startswith("reference/"):
        return []
    if source in GATHERED:
        return heading_of_gathered(root, GATHERED[source].records(root), document, old)
    record = record_of(root, source)
    if not record:
        when = max(row["measured"] for row in csv_rows(root, source))[:10]
        return [f"Measured until {when}, before there was a record; {CHANGED}.", ""]
    study = study_of(record)
    changed = has_changed(root, study["study"])
    changed = CHANGED in old if changed is None else changed
    return [f"Recorded on {study['ended'][:10]}, {link(study['commit'], record, document)}"
            f"{'; ' + CHANGED if changed else ''}.", ""]


def heading_of_gathered(root, records, document, old):
    """records: by the names of their studies."""
    links, changed = [], []
    for name, record in records.items():
        links.append(link(name, record, document))
        now = has_changed(root, name)
        if f"`{name}`" in old if now is None else now:
            changed.append(f"`{name}`")
    if not links:
        return []
    sources = f" The sources of {', '.join(changed)} have changed since." if changed else ""
    return [f"Recorded: {', '.join(links)}; what no record has stands in the reference.{sources}", ""]


@functools.cache
def summary(root):
    """Rows of the reference run by scenario and label."""
    return by_method(json.loads(file_of(root, SUMMARY).read_text())["rows"], "label")


@functools.cache
def dynamics(root):
    """Rows of the closed loop in which a step is a frame, by scenario and method."""
    return by_method(row for row in csv_rows(root, DYNAMICS) if not row.get("within"))


PAPER_SCENES = ("tt", "mv", "ww")


def loops(root, methods, others=False):
    """Rows of the closed loop of some methods: those of the paper's scenes, or of all other scenes."""
    return [row for (scene, method), row in dynamics(root).items()
            if method in methods and (scene in PAPER_SCENES) != others]


def races(root):
    return csv_rows(root, RACES)


def reference_table(root):
    rows = summary(root)
    shown = (
        ("fcl-aabb", "FCL, axis-aligned boxes, default settings"),
        ("aabb-tree", "our box tree, refit in every frame"),
        ("certified", "boxes deformed on demand, with proof"),
        ("particle-paper:n=5,start=fps", "the paper's method, begun at places far apart"),
        ("particle:n=16", "particles that track the closest pairs"),
    )
    yield ("| method | µs a frame (95 % interval) | times faster than FCL | exact frames | largest error | "
           "missed contacts | memory |")
    yield "| --- | --- | --- | ---: | ---: | ---: | ---: |"
    for label, what in shown:
        row = rows["ww", label]
        time, ratio, error = row["total_ns"], row["ratio"], row["error"]
        times = interval(*(time[key] / 1e3 for key in ("median", "ci_low", "ci_high")))
        faster = "1" if label == "fcl-aabb" else interval(ratio["value"], ratio["ci_low"], ratio["ci_high"])
        largest = f"{error['max']:.2g} L" if error["max"] > 1e-9 else "0"
        yield (f"| `{label}`: {what} | {times} | {faster} | {exact_text(error['exact_rate'])} | {largest} | {row['missed']:g} | "
               f"{size(row['heap_live_bytes'])} |")


def figure(root, source, what):
    return f"![{what}](../{file_of(root, source).relative_to(root)})"


PARTICLES = ["particle-paper:n=%d,law=log" % n for n in (1, 2, 3, 4, 5, 8, 16)]


def dynamics_table(root):
    rows = dynamics(root)
    yield "| scene | n = 1 | 2 | 3 | 4 | 5 | 8 | 16 | tracked, n = 8 | certified |"
    yield "| --- " * 10 + "|"
    for scene in ("tt", "mv", "ww", "twist", "comb"):
        cells = []
        for method in PARTICLES + ["particle:n=8", "certified"]:
            row = rows[scene, method]
            share, low, high = (float(row[key]) for key in ("share", "low", "high"))
            cells.append(f"{percent(share)} ({percent(low)}-{percent(high)})" if share else f"0 (< {percent(high)})")
        tried = int(rows[scene, "certified"]["approaches"])
        name = scene if tried == 1000 else f"{scene} ({tried})"
        yield f"| {name} | " + " | ".join(cells) + " |"
    yield ""
    yield figure(root, "dynamics/dynamics.svg", "Share of approaches with a pass through over the number of particles")


LETTERS = {0.1: "w-1000-0.1", 1: "w-1000-1", 4: "w-1000-4"}


@functools.cache
def bodies(root):
    """Rows of the scenes of several bodies by scene and method."""
    return by_method(csv_rows(root, BODIES))


def step(root, scene, method):
    return float(bodies(root)[scene, method]["step_mean_ns"])


def step_cells(times):
    """Cells of milliseconds; all but the first say how many times the first they take."""
    return [digits(times[0] / 1e6), *(f"{digits(time / 1e6)} ({digits(time / times[0])} times)" for time in times[1:])]


def step_head(columns, methods):
    yield f"| {' | '.join(columns)} | " + " | ".join(f"`{method}`" for method in methods) + " |"
    yield "| ---: " * len(columns) + "| --- " * len(methods) + "|"


def bodies_table(root):
    methods = ("certified", "fcl-aabb:refit=every", "fcl-aabb", "aabb-tree", "particle:n=8", "particle-paper:n=5")
    yield from step_head(("near pairs a body", "asked about", "steps"), methods)
    for density, scene in LETTERS.items():
        cells = step_cells([step(root, scene, method) for method in methods])
        for k, method in enumerate(methods):
            found, missed = (int(float(bodies(root)[scene, method][key])) for key in ("contacts", "missed"))
            if missed:
                cells[k] += f", {missed} of {found + missed:,} contacts missed"
        ours = bodies(root)[scene, "certified"]
        asked = digits(float(ours["near_pairs_a_body"]))
        yield f"| {density} | {asked} | {ours['steps']} | " + " | ".join(cells) + " |"


def crowd_table(root):
    """Characters: the same methods but the particles, from a run of its own."""
    methods = ("certified", "aabb-tree", "fcl-aabb", "fcl-aabb:refit=every")
    rows = by_method(csv_rows(root, CROWDS), "label")
    yield from step_head(("near pairs a body", "steps"), methods)
    for density in LETTERS:
        scene = f"crowd-200-{density}"
        cells = step_cells([float(rows[scene, method]["active_total_ns_mean"]) for method in methods])
        yield f"| {density} | {rows[scene, 'certified']['frames']} | " + " | ".join(cells) + " |"


def megabytes(root, scene, method="certified"):
    return float(bodies(root)[scene, method]["rss_peak_bytes"]) / 1e6


def gains(root, options):
    """How many times as fast a step of 1,000 letters is with some threads, for each density."""
    rows = json.loads(file_of(root, "bodies/bodies.json").read_text())["gains"]
    return [next(row["gain"] for row in rows if row["bodies"] == 1000 and row["method"] == f"certified:{options}"
                 and abs(row["near_pairs"] - density) < 1e-9) for density in LETTERS]


# Of these, only contact is asked, or no body deforms and nobody has to refit (the table of engines has some); crowd is no pair.
NOT_AMONG_PAIRS = ("tt", "ww-contact", "mv-contact", "tt-distance", "rigid-ww", "rigid-mv", "flat", "sliver-3", "sliver-6",
                   "still", "touch", "crowd")


@functools.cache
def pairs(root):
    """The finished rows of the full bench, hot and charged for everything, by scenario and label; of rows alike, that
    of the most frames."""
    found = {}
    for row in csv_rows(root, BENCH):
        if (row["status"], row["cache"], row["accounting"]) == ("ok", "hot", "charged"):
            key = (row["scenario"], row["label"])
            if key not in found or frames_of(row) > frames_of(found[key]):
                found[key] = row
    return found


def frames_of(row):
    return int(row["frames"]) * int(row["stride"])


def accuracy(row):
    """The share of exact answers, missed contacts, and all contacts."""
    return tuple(float(row[key]) for key in ("exact_rate", "missed", "contacts"))


def accuracy_text(row):
    exact, missed, contacts = accuracy(row)
    return f"{exact_text(exact)}, {missed:.3g} of {contacts:.3g}"


def pairs_table(root):
    yield ("| scene | processes, frames | `certified`, median in µs | best FCL | `aabb-tree` | `particle:n=8` | exact, missed | "
           "`particle-paper:n=8` | exact, missed |")
    yield "| --- | ---: | ---: | ---: | ---: | ---: | --- | ---: | --- |"
    rows = pairs(root)
    for scenario in sorted({scenario for scenario, _ in rows} - set(NOT_AMONG_PAIRS)):
        ours = rows[scenario, "certified"]
        median = float(ours["total_ns_median"])
        cells = [scenario, f"{ours['replicates']}, {int(ours['frames']):,}", digits(median / 1e3), digits(float(ours["ratio_best"]))]
        for label in ("aabb-tree", "particle:n=8", "particle-paper:n=8"):
            row = rows.get((scenario, label))
            cells.append(digits(float(row["total_ns_median"]) / median) if row else "–")
            if label != "aabb-tree":
                cells.append(accuracy_text(row) if row else "refused")
        yield f"| {' | '.join(cells)} |"
    yield ""
    yield figure(root, "bench/size-time.svg", "Time of a query of two letters W over their number of triangles")


def measured(value):
    """A value of a claim that its verdict follows from: name, value and interval, with three digits."""
    def shown(number):
        return "0" if value["unit"] == "L" and abs(number) < 1e-9 else f"{number:.3g}"
    if value["value"] is None:
        return f"{value['name'].strip()}: not measured"
    low, high = value["interval"] or (None, None)
    ends = "" if low == high else f" ({shown(low)} to {shown(high)})"
    return f"{value['name'].strip()}: {shown(value['value'])}{ends}{' ' * bool(value['unit'])}{value['unit']}"


def claims_table(root):
    yield "| claim | paper | verdict | measured |"
    yield "| --- | --- | --- | --- |"
    for claim in json.loads(file_of(root, CLAIMS).read_text()):
        values = "; ".join(measured(value) for value in claim["values"] if value["threshold"])
        yield f"| {claim['id']}. {claim['claim']} | {claim['section']} | {claim['verdict']} | {values} |"


def extremes_table(root):
    """How many extremes each method answers rightly, and the figure that shows which not."""
    methods = json.loads(file_of(root, EXTREMES).read_text())["methods"]
    verdicts = list(methods[0]["verdicts"])
    yield "| method | " + " | ".join(verdicts) + " |"
    yield "| --- " + "| ---: " * len(verdicts) + "|"
    for method in methods:
        yield f"| `{method['name']}` | " + " | ".join(str(method["verdicts"][key]) for key in verdicts) + " |"
    yield ""
    yield figure(root, "extremes/extremes.svg", "Verdict on each method in each numerical extreme")


ABLATION_SCENES = ("ww", "fast-25", "jump", "comb", "ww-1m")
WITHOUT = ("fits=constant", "seed=none", "seed=pair", "seed=tracked", "plane=off", "directions=off", "restarts=0", "width=4",
           "width=2", "slack=1e-06", "slack=0.001")


def ablation_table(root):
    """Times without a step of the certified query, or with another width or slack, over those with all of them."""
    rows = by_method(csv_rows(root, ABLATION), "label")
    yield f"| | {' | '.join(ABLATION_SCENES)} |"
    yield "| --- " + "| ---: " * len(ABLATION_SCENES) + "|"
    for option in WITHOUT:
        times = [float(rows[scene, f"certified:{option}"]["total_ns_median"]) / float(rows[scene, "certified"]["total_ns_median"])
                 for scene in ABLATION_SCENES]
        yield f"| `{option}` | {' | '.join(f'{time:.2f}' for time in times)} |"


@functools.cache
def ingredients(root, label, scene="comb"):
    """Of tracked particles with some part changed: median time, per cent of exact frames, and missed contacts."""
    row = by_method(csv_rows(root, INGREDIENTS), "label")[scene, label]
    exact, missed, _ = accuracy(row)
    return (float(row["total_ns_median"]), 100 * exact, missed)


def ingredients_figure(root):
    yield figure(root, "ingredients/ingredients.svg", "What each part of the tracked particles brings on five scenes")


def launches(root):
    """With eight launches a query: per cent of exact frames, missed contacts a run, and the time to that of none."""
    time, exact, missed = ingredients(root, "particle:n=8,launch=8")
    return (exact, missed, time / ingredients(root, "particle:n=8")[0])


@functools.cache
def ratios(root):
    """What `make ratios` printed, by case: microseconds of stream, aabb-tree and FCL, and their ratios to stream."""
    lines = file_of(root, RATIOS).read_text().splitlines()[1:]
    return {case: [float(number) for number in numbers] for case, *numbers in map(str.split, lines)}


def ratios_table(root):
    yield "| case | stream, us a frame | aabb-tree | best FCL | to the tree | to FCL |"
    yield "| --- | ---: | ---: | ---: | ---: | ---: |"
    for case, numbers in ratios(root).items():
        yield f"| {case} | {' | '.join(map(digits, numbers))} |"


def stream_and_tree(root, *cases):
    """Microseconds of stream and of aabb-tree, case by case."""
    return [digits(time) for case in cases for time in ratios(root)[case][:2]]


def share_of_tree(root, case):
    stream, tree, *_ = ratios(root)[case]
    return stream / tree


def largest_share_of_tree(root):
    """The case in which stream gains least, and its time to that of aabb-tree."""
    return max((share_of_tree(root, case), case) for case in ratios(root))


@functools.cache
def autos(root):
    """What `make auto` printed, by scenario: microseconds of certified, stream and auto, and auto's two ratios."""
    lines = file_of(root, AUTO).read_text().splitlines()[1:-1]
    return {name: [float(number) for number in numbers[:5]] for name, *numbers in map(str.split, lines)}


def auto_table(root):
    yield "| scenario | certified, us a frame | stream | auto | auto to the better, median | sum from frame 50 on |"
    yield "| --- | ---: | ---: | ---: | ---: | ---: |"
    for name, (*times, median, total) in autos(root).items():
        yield f"| {name} | {' | '.join(map(digits, times))} | {median:.2f} | {total:.2f} |"


def readers_table(root):
    """The table of make readers, but its last two columns."""
    for line in file_of(root, READERS).read_text().split("\n\n")[0].splitlines():
        yield "|".join(line.split("|")[:-3]) + "|"


def numbers_of(text):
    return [float(number) if "." in number else int(number) for number in re.findall(r"\d+(?:\.\d+)?", text)]


def readers_total(root):
    """How many files there are, how many mote reads as meshes, and how many it refuses."""
    return numbers_of(file_of(root, READERS).read_text().split("\n\n")[1])[:3]


def animated_files(root):
    """How many files have clips, how many are read, and how many of these have no edge of more than two faces."""
    return numbers_of(file_of(root, ANIMATED).read_text())[:3]


def python_table(root):
    yield "| scenario | loop in C | batch | its ratio to C | single calls | more than C |"
    yield "| --- | ---: | ---: | ---: | ---: | ---: |"
    for line in file_of(root, PYTHON).read_text().splitlines():
        scenario, _, text = line.partition(":")
        in_c, call, more, batch, ratio, _ = numbers_of(text)
        yield f"| {scenario} | {in_c} | {batch} | {ratio} | {call} | {more} |"


TABLES = {SUMMARY: reference_table, BENCH: pairs_table, BODIES: bodies_table, CROWDS: crowd_table, ENGINES: engines_table,
          PEERS: peers_tables, VERDICTS: verdicts_table,
          LARGE_VERDICTS: functools.partial(verdicts_table, source=LARGE_VERDICTS), DYNAMICS: dynamics_table,
          LONG_STEPS: long_steps_table, SHORT_STEPS: short_steps_table, SPEED: impact_table, FCL_SPEED: fcl_table,
          CHARACTERS: characters_table,
          TUNE: tune_table, PARTS: parts_table, CLAIMS: claims_table, EXTREMES: extremes_table, RATIOS: ratios_table,
          AUTO: auto_table, ABLATION: ablation_table, INGREDIENTS: ingredients_figure, READERS: readers_table, PYTHON: python_table,
          **{name: gathered.table for name, gathered in GATHERED.items()}}


def pass_through(root, scene, n, law="log"):
    return percent(float(dynamics(root)[scene, f"particle-paper:n={n},law={law}"]["share"]))


def missed_steps(root, method, *scenes):
    rows = [dynamics(root)[scene, method] for scene in scenes]
    missed, touching = (sum(int(row[key]) for row in rows) for key in ("missed_steps", "contact_steps"))
    return f"{missed} of {touching:,}"


def particles(*counts):
    return [f"particle-paper:n={n},law=log" for n in counts]


def missed_shares(root, counts, others=False):
    """Of the frames in contact, which share the paper's particles miss, scene by scene."""
    return [int(row["missed_steps"]) / int(row["contact_steps"]) for row in loops(root, particles(*counts), others)]


def worst_reports(root, others=False):
    """The longest delay, in frames, and the deepest penetration of 3 to 5 particles."""
    rows = loops(root, particles(3, 4, 5), others)
    return (max(int(row["delay_max"]) for row in rows), max(float(row["max_penetration_unreported"]) for row in rows))


def query_times(root, *methods):
    """The least and the largest time of a frame of the paper's scenes, in microseconds."""
    return span([float(row["query_ns"]) / 1e3 for row in loops(root, methods)])


def failures(root, check):
    tried, failed, _ = checks(root)["random scenarios: " + check]
    return (failed, tried)


def unchanged(root, place):
    found = [r for r in races(root) if r["plant"] == "none" and r["place"] in place]
    wrong = sum(r["slower"] != "0" or r["faster"] != "0" for r in found)
    return (wrong, len(found))


def planted(root, least, most, place=("idle", "compiler"), plant=None):
    """How many races with a slowdown of least .. most per cent named the slowed row, and of how many."""
    found = [r for r in races(root) if r["place"] in place and least <= int(r["per_cent"]) <= most
             and (r["plant"] == plant if plant else r["plant"] != "none")]
    return (sum(r["named_alone"] != "0" for r in found), len(found))


def reference_row(root, label, scenario="ww"):
    return summary(root)[scenario, label]


def times_of_particles(root, scenario):
    """The time of the certified query over that of the paper's method."""
    exact, paper = (reference_row(root, label, scenario)["total_ns"]["median"]
                    for label in ("certified", "particle-paper:n=5,start=fps"))
    return exact / paper


# Where the paper's method with eight particles answers, too.
LETTER_SCENES = ("mv", "tw", "twist", "vv", "ww", "ww-1k", "ww-10k", "ww-100k", "ww-1m", "ww-10m")
CHARACTER_SCENES = ("hands", "jumper-20k", "jumper-80k", "jumper-330k", "jumper-near-20k", "jumper-near-330k")


def exactness(root, scenario, label):
    """Frames of the full bench, and per cent of them that are exact."""
    row = pairs(root)[scenario, label]
    return (int(row["frames"]), 100 * accuracy(row)[0])


def tracked(root, scenario):
    """What the tracked particles did in the full bench: per cent of exact frames, missed contacts, and all contacts."""
    exact, missed, contacts = accuracy(pairs(root)[scenario, "particle:n=8"])
    return (100 * exact, missed, contacts)


def tracked_on_letters(root):
    """The least and the largest percentage of exact frames, missed contacts, and all contacts."""
    exact, missed, contacts = zip(*(tracked(root, scenario) for scenario in LETTER_SCENES))
    return (*span(exact), sum(missed), sum(contacts))


def wrong_rows(root):
    """Of the rows of the full bench by exact methods, ours and others': how many, and how many have a wrong answer."""
    rows = [row for row in csv_rows(root, BENCH) if row["status"] == "ok" and not row["method"].startswith("particle")]
    wrong = [row for row in rows if not is_right(row)]
    return (len(rows), len(wrong))


def times_of_eight(root, scenarios):
    """The time of the certified query over that of the paper's method with eight particles."""
    return [float(pairs(root)[scenario, "certified"]["total_ns_median"])
            / float(pairs(root)[scenario, "particle-paper:n=8"]["total_ns_median"]) for scenario in scenarios]


def slower_eights(root):
    """On how many scenes of the table the paper's method takes longer than the exact query, and of how many."""
    scenarios = {scenario for scenario, label in pairs(root) if label == "particle-paper:n=8"} - set(NOT_AMONG_PAIRS)
    return (sum(time < 1 for time in times_of_eight(root, scenarios)), len(scenarios))


# Document, sentence with places for values, and the values.
SENTENCES = [
    ("README.md", "(frames {} to {}, {:.0f} of them in contact, {} processes a method,", lambda root: (
        *reference_row(root, "certified")["frame_range"], reference_row(root, "certified")["contacts"],
        reference_row(root, "certified")["replicates"])),
    ("README.md", "the particles are {:.0f}00 times faster than it", lambda root: (
        reference_row(root, "particle-paper:n=5,start=fps")["ratio"]["value"] // 100,)),
    ("README.md", "On the paper's letters the particles need {:.1f} to {:.1f} of the time of the fastest exact query", lambda root: (
        1 / times_of_particles(root, "ww"), 1 / times_of_particles(root, "mv"))),
    ("README.md", "(FCL or ODE) takes {} to {} times as long, by the medians of one run", lambda root: (
        map(digits, span([times(root, scenario) for scenario in ("ww", "mv", "ww-contact", "mv-contact")])))),
    ("README.md", "ODE takes {:.2f} to {:.2f} of its time for contacts", lambda root: (
        span([ode_to_fcl(root, scenario) for scenario in ("ww-contact", "mv-contact")]))),
    ("docs/peers.md", "ODE is the best of the others, in {:.2f} (`mv`) to {:.2f} (`ww`) of FCL's time. It takes {} times as long as "
     "`certified` on `ww` and {} times on `mv` ({} and {} by the mean), and {} and {} times as long as `aabb-tree`", lambda root: (
        *(ode_to_fcl(root, scenario) for scenario in ("mv-contact", "ww-contact")),
        *(digits(times(root, scenario, key)) for key in ("median", "mean") for scenario in ("ww-contact", "mv-contact")),
        *(digits(times(root, scenario) / times(root, scenario, wanted=is_tree)) for scenario in ("ww-contact", "mv-contact")))),
    ("docs/peers.md", "`make tune PROFILE=full` measures {} settings of these engines on {} scenes", count_of_settings),
    ("docs/peers.md", "`make engines` has the fastest of each of its scenes but {}", fastest_not_asked),
    ("docs/peers.md", "FCL's oriented volumes take at least {:.0f} to {:.0f} times as long as its axis-aligned boxes", lambda root: (
        span([oriented_to_boxes(root, scenario) for scenario in ("ww", "mv", "bison-15k", "jumper-20k")]))),
    ("docs/peers.md", "takes {} times the median of `certified` on `tt`, {} times on the path of `ww` and {} times on the path of `mv`, and "
     "{}, {} and {} times its mean", lambda root: (
        digits(times(root, scenario, key)) for key in ("median", "mean") for scenario in ("tt", "rigid-ww", "rigid-mv"))),
    ("docs/peers.md", "FCL is the best of Debian's engines. It takes {} times as long as `certified` on `ww`, {} times on `mv` and {} times "
     "on `tt`", lambda root: (digits(times(root, scenario)) for scenario in ("ww", "mv", "tt-distance"))),
    ("docs/peers.md", "in each of the {} frames without one, RSS in {}. RSS bottom-up also misses {} of the {} contacts that {} other "
     "deforming scenarios have in the frames in which it was asked, and {} of {} on `spider`", oriented_bottom_up),
    ("docs/peers.md", "Bullet invents contacts on the slivers ({} and {}), on `spider` ({}), on `twist` ({}) and on `touch` ({})",
     lambda root: invented(root, "bullet-gimpact", "sliver-3", "sliver-6", "spider", "twist", "touch")),
    ("docs/peers.md", "ODE invents {} on `touch`", lambda root: invented(root, "ode", "touch")),
    ("docs/peers.md", "is wrong in {} of {} scenarios; {} of the {} contacts that it invents are on `shell`", convex),
    ("docs/impact.md", "Of {:,} approaches of all ten scenes in steps of 1, 3, 10 and 30 frames {} pass with continuous steps, {} surfaces "
     "intersect at any time looked at, and {} flights are unproven", lambda root: (
        sums(root, "continuous", "approaches", "passes_through", "intersecting", "floor_unproven"))),
    ("docs/impact.md", "Sampled at the ends of steps of 30 frames, {1} of {0:,} pass and {2:,} intersect", lambda root: (
        sums(root, "sampled", "approaches", "passes_through", "intersecting", least=30))),
    ("docs/impact.md", "finding every impact frame by frame takes {:.1f} times as long as a sample each frame, and in steps of ten "
     "frames {:.1f} times", lambda root: [continuous_to_sampled(root, "ww", step) for step in (1, 10)]),
    ("docs/impact.md", "At steps of 100 frames, 30 samples take {:.2f} to {:.2f} of the time of `certified` and miss {:.0f} of {:.0f} impacts",
     lambda root: long_questions(root, "impact-sampled:samples=30")),
    ("docs/impact.md", "Three samples miss {2:.0f} of them", lambda root: long_questions(root, "impact-sampled:samples=3")),
    ("docs/findings.md", "more than {:.0f}00 times as fast as FCL's trees, and {:.1f} % of their distances are exact",
     lambda root: (
        reference_row(root, "particle-paper:n=5,start=fps")["ratio"]["value"] // 100,
        100 * reference_row(root, "particle-paper:n=5,start=fps")["error"]["exact_rate"])),
    ("README.md", "of all {:,} frames the paper's method answers {:.1f} % exactly", lambda root: (
        exactness(root, "ww", "particle-paper:n=5,start=fps"))),
    ("docs/findings.md", "of all {:,} frames it is {:.1f} %", lambda root: (
        exactness(root, "ww", "particle-paper:n=5,start=fps"))),
    ("docs/findings.md", "exact in {:.0f} % of frames on `comb`, {:.0f} of {:.0f} contacts missed; in {:.0f} % on `jumper-330k`, "
     "{:.0f} of {:.0f} missed", lambda root: (*tracked(root, "comb"), *tracked(root, "jumper-330k"))),
    ("docs/findings.md", "on `comb` it is exact in {:.0f} % of the frames and misses {:.0f} of {:.0f} contacts, on `spider` in "
     "{:.0f} % ({:.0f} of {:.0f} missed)", lambda root: (*tracked(root, "comb"), *tracked(root, "spider"))),
    ("docs/findings.md", "they miss contacts: {:.0f} of {:.0f} on `comb`, {:.0f} of {:.0f} of a character (`jumper-330k`)",
     lambda root: (*tracked(root, "comb")[1:], *tracked(root, "jumper-330k")[1:])),
    ("docs/findings.md", "exact in {:.1f} to {:.0f} % of the frames on the letters and misses {:.0f} of their {:,.0f} contacts",
     tracked_on_letters),
    ("docs/findings.md", "Of the {} rows of `certified`, `aabb-tree` and the engines of others in this run, {} have a distance that is "
     "not exact or a wrong verdict", wrong_rows),
    ("docs/findings.md", "with 8 particles it takes longer than `certified` on {} of {} scenes", slower_eights),
    ("docs/findings.md", "exact for {:.1f} to {:.1f} times the time of the paper's mode with 8 particles on the letters, and for "
     "{:.1f} to {:.1f} times on characters", lambda root: (
        *span(times_of_eight(root, LETTER_SCENES)), *span(times_of_eight(root, CHARACTER_SCENES)))),
    ("docs/findings.md", "gives it for {:.2f} of the time of a tree that is refitted on `ww`, and for {:.2f} where it gains least (`{}`)",
     lambda root: (share_of_tree(root, "12k-letter"), *largest_share_of_tree(root))),
    ("docs/findings.md", "it takes {} µs a frame on the letters of `ww`, `aabb-tree` {}; {} and {} on `twist`, {} and {} on `fast-100`, "
     "{} and {} on `jump`, {} and {} on `still`, {} and {} on `fast-5`, {} and {} on letters of 100,000 triangles. Cloth at rest on "
     "a letter, which is near it everywhere, takes {} and {}", lambda root: (
        stream_and_tree(root, "12k-letter", "twist", "fast-100", "jump", "still", "fast-5", "100k-letter", "cloth-11920"))),
    ("docs/findings.md", "at a million triangles, {:.1f} to {:.1f} times as fast as `aabb-tree` only", lambda root: (
        span([1 / share_of_tree(root, case) for case in ("1m-letter", "1m-leaf")]))),
    ("docs/findings.md", "With 8 launches in each query it is exact in {:.0f} % of the frames on `comb` and misses {:.1f} contacts a run, for "
     "{:.1f} times the time", launches),
    ("docs/characters.md", "Side by side the bison take {} us instead of {}, and their 95th percentile is {} us", lambda root: (
        characters(root)["bison-15k"][0], characters(root)["bison-near-15k"][0], characters(root)["bison-15k"][1])),
    ("docs/characters.md", "where bones alone move a body, an exact answer costs {:.1f} to {:.1f} times what rigid parts do",
     exact_to_parts),
    ("docs/characters.md", "Of {} animated files of Debian's `assimp-testmodels` {} are read, {} of them without an edge of more than two faces",
     animated_files),
    ("docs/benchmarking.md", "`make readers` reads each of the {} files", lambda root: readers_total(root)[:1]),
    ("docs/benchmarking.md", "mote reads {} as meshes and refuses {}", lambda root: readers_total(root)[1:]),
    ("docs/findings.md", "passes through the other in {} % of 1,000 approaches; with 3 particles it is {} %",
     lambda root: (pass_through(root, "ww", 5), pass_through(root, "ww", 3))),
    ("docs/findings.md", "for {:.1f} (`mv`) to {:.1f} times (`ww`) the time of the particles", lambda root: (
        times_of_particles(root, "mv"), times_of_particles(root, "ww"))),
    ("docs/findings.md", "up to {} % of approaches pass through at n = 3 (`twist`), up to {} % still at n = 16 (`comb`)",
     lambda root: (pass_through(root, "twist", 3), pass_through(root, "comb", 16))),
    ("docs/findings.md", "{} % of the bodies pass through with 3 particles and {} % with 5", lambda root: (
        pass_through(root, "ww", 3), pass_through(root, "ww", 5))),
    ("docs/findings.md", "it is up to {} % and {} %", lambda root: (
        pass_through(root, "twist", 3), pass_through(root, "comb", 3))),
    ("docs/findings.md", "the particles miss {:.0f} to {:.0f} % of the frames in contact on T-T, M-V and W-W, report a "
     "contact up to {} frames after it began, and the bodies penetrate by up to {:.2f} L", lambda root: (
        100 * min(missed_shares(root, (3, 4, 5))), 100 * max(missed_shares(root, (3, 4, 5))), *worst_reports(root))),
    ("docs/findings.md", "up to {:.0f} % missed (`comb`), {} frames late (`ww-100k`), and {:.2f} L deep (`bunny`)",
     lambda root: (100 * max(missed_shares(root, (3, 4, 5), True)), *worst_reports(root, True))),
    ("docs/findings.md", "With 16 particles, {} of {:,} approaches passes through on the paper's scenes, and at most "
     "{:.1f} % of the frames in contact are missed; on `comb` it is {:.0f} %", lambda root: (
        *(sum(int(row[key]) for row in loops(root, particles(16))) for key in ("passes_through", "approaches")),
        100 * max(missed_shares(root, (16,))), 100 * max(missed_shares(root, (16,), True)))),
    ("docs/findings.md", "tracked and certified {:.0f} to {:.0f} µs, the paper's mode with 5 particles {:.0f} to "
     "{:.0f} µs, FCL {:,.0f} to {:,.0f} µs", lambda root: (
        *query_times(root, "particle:n=8", "certified"), *query_times(root, *particles(5)),
        *(round(time, -2) for time in query_times(root, "fcl-aabb:seed=previous,queue=64")))),
    ("docs/certified.md", "On an idle machine a step of these letters takes {:.1f} ms", lambda root: (
        step(root, LETTERS[4], "certified") / 1e6,)),
    ("docs/findings.md", "takes at most {:.0f} MB with `certified` and {:.1f} GB with `refit=every`; with 10,000 letters "
     "of 4 shapes `certified` takes {:.0f} MB at 4 near pairs a body", lambda root: (
        max(megabytes(root, scene) for scene in LETTERS.values()),
        megabytes(root, LETTERS[4], "fcl-aabb:refit=every") / 1e3, megabytes(root, "letters-10000-4"))),
    ("docs/findings.md", "takes {:.2f}, {:.2f} and {:.2f} of the time with `threads=2` at 0.1, 1 and 4 near pairs a body, {:.2f}, "
     "{:.2f} and {:.2f} with `ahead=3`, and {:.2f}, {:.2f} and {:.2f} with both", lambda root: (
        1 / gain for options in ("threads=2", "ahead=3", "threads=2,ahead=3") for gain in gains(root, options))),
    ("docs/findings.md", "of {:,} distances of `certified` in random scenes, {} lay farther than 1e-12 L "
     "from it, for a reason given there, and {} lower bounds above it", lambda root: (
        *reversed(failures(root, "certified beyond 1e-12 L of the truth")),
        failures(root, "a lower bound above the truth")[0])),
    ("docs/findings.md", "The answer is wrong by {} L, and", lambda root: (power(furthest_off(root)[0]),)),
    ("docs/findings.md", "In another such scene it lies {} L below, the most in these scenarios", lambda root: (
        power(furthest_off(root)[1]),)),
    ("docs/findings.md", "a lower bound {} L below the distance, and [one distance](#how-far-an-exact-answer-can-be-trusted) too "
     "large by {} L", lambda root: map(power, reversed(furthest_off(root)))),
    ("docs/findings.md", "random scenes in {:.1f} % of {:,} frames ({:,} missed). The paper's particles, five a body, are "
     "exact in {:.0f} % of {:,} such frames and miss {:,} contacts; `aabb-tree` is exact in all, and `certified` within "
     "1e-12 L in all but {}", lambda root: (
        *soaked(root, "particle:n=8"), *soaked(root, "particle-paper:n=5"),
        failures(root, "certified beyond 1e-12 L of the truth")[0])),
    ("docs/findings.md", "it misses {} frames in contact on the paper's scenes, {} on `twist` and {} on the comb",
     lambda root: (
        missed_steps(root, "particle:n=8", "tt", "mv", "ww"), missed_steps(root, "particle:n=8", "twist"),
        missed_steps(root, "particle:n=8", "comb"))),
    ("docs/findings.md", "{}, {} and {} % pass through at n = 3, 4 and 5 with the inverse law", lambda root: (
        pass_through(root, "ww", n, "inverse") for n in (3, 4, 5))),
    ("docs/findings.md", "{}, {} and {} % with the inverse square", lambda root: (
        pass_through(root, "ww", n, "inverse-square") for n in (3, 4, 5))),
    ("docs/benchmarking.md", "{} of {} unchanged builds were called faster or slower on an idle machine, and {} of {} "
     "beside a compiler", lambda root: (*unchanged(root, ("idle",)), *unchanged(root, ("compiler",)))),
    ("docs/benchmarking.md", "On the idle machine {} of {} races named a slowdown of 2 % in the certified query, {} of "
     "{} one in the particle sweep, and {} of {} one in the reading of the clock; beside a compiler {} of {}, {} of {} "
     "and {} of {} did, and of 5 % {} of {}, {} of {} and {} of {}", lambda root: (
        value for size, place in ((2, "idle"), (2, "compiler"), (5, "compiler"))
        for plant in ("certified query", "particle sweep", "clock path")
        for value in planted(root, size, size, (place,), plant))),
    ("docs/benchmarking.md", "{} of {} races named a slowdown of 3 % or more, wherever it was planted", lambda root: (
        planted(root, 3, 10))),
    ("README.md", "a slowdown of 2 % in a query of microseconds was found in {} of {} races on an idle machine, and "
     "{} of {} races of unchanged builds saw a change, {} of them beside a compiler", lambda root: (
        *map(sum, zip(*(planted(root, 2, 2, ("idle",), plant) for plant in ("certified query", "particle sweep")))),
        *unchanged(root, ("idle", "compiler")), unchanged(root, ("compiler",))[1])),
    ("docs/benchmarking.md", "Of 1 %, which is where a change begins to count, {} of {} did", lambda root: (
        planted(root, 1, 1))),
]


def documents(root):
    return [root / "README.md", *sorted((root / "docs").glob("*.md")), root / "results/reference/reliability.md"]


def blocks(document, text):
    """The tables of a document: source, and where the lines between its marks begin and end."""
    for match in re.finditer(r"^<!-- from (\S+) -->\n", text, re.MULTILINE):
        end = text.find(END + "\n", match.end())
        if end < 0:
            raise ValueError(f"{document}: after the line {match[0].strip()} there is no line {END}")
        if match[1] not in TABLES:
            raise ValueError(f"{document}: no table is made from {match[1]}; there are {', '.join(TABLES)}")
        yield match[1], match.end(), end


def rewritten(root, document):
    """The text of a document, and what it should be."""
    text = new = document.read_text()
    for source, begin, end in reversed(list(blocks(document, text))):
        lines = heading(root, source, document, text[begin:end]) + list(TABLES[source](root))
        new = new[:begin] + "\n" + "\n".join(lines) + "\n\n" + new[end:]
    return text, new


def disagreements(root):
    for document in documents(root):
        text, new = rewritten(root, document)
        if new != text:
            yield f"{document.relative_to(root)}: a table is not that of its source; `make documents` writes it"
    for document, sentence, values in SENTENCES:
        expected = sentence.format(*values(root))
        if expected not in " ".join((root / document).read_text().split()):
            yield f"{document}: by the stored results it should say: {expected}"


def main(arguments):
    if len(arguments) < 1 or arguments[1:] not in ([], ["--check"]):
        print("usage: documents.py ROOT [--check]", file=sys.stderr)
        return 2
    root = Path(arguments[0])
    try:
        if arguments[1:] == []:
            for document in documents(root):
                text, new = rewritten(root, document)
                if new != text:
                    document.write_text(new)
        wrong = list(disagreements(root))
    except (OSError, KeyError, ValueError) as error:
        print(f"documents: {error}", file=sys.stderr)
        return 4
    for line in wrong:
        print(f"documents: {line}", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
