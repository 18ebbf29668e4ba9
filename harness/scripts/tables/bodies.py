"""Steps of many bodies, from a run of `make bodies`."""
import functools
import json
import statistics

from tables.number_text import digits
from tables.records import by_method, csv_rows, file_of

BODIES = "bodies/bodies.csv"
CROWDS = "bodies/characters-summary.csv"
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


def asked(root, density):
    """How many pairs of 1,000 letters are asked about in a step, and per cent of the near ones that are left out."""
    row = bodies(root)[LETTERS[density], "certified"]
    pairs = float(row["near_pairs_a_body"])
    return pairs * int(row["bodies"]), 100 * (1 - pairs / density)


def bounds_of_body(root):
    """The median over all scenes: microseconds that the box of a body takes in a step."""
    return statistics.median(float(row["bounds_ns"]) / int(row["bodies"]) / 1e3 for (_, method), row in bodies(root).items()
                             if method == "certified")


def megabytes(root, scene, method="certified"):
    return float(bodies(root)[scene, method]["rss_peak_bytes"]) / 1e6


def gains(root, options):
    """How many times as fast a step of 1,000 letters is with some threads, for each density."""
    rows = json.loads(file_of(root, "bodies/bodies.json").read_text())["gains"]
    return [next(row["gain"] for row in rows if row["bodies"] == 1000 and row["method"] == f"certified:{options}"
                 and abs(row["near_pairs"] - density) < 1e-9) for density in LETTERS]
