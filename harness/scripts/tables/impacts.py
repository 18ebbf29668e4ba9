"""Tables of docs/impact.md: impacts between frames by several methods, and steps of the closed loop in which they are
found."""
import functools
import statistics

from tables.number_text import digits, span
from tables.records import csv_rows, file_of

SPEED = "impact-speed/summary.csv"
FCL_SPEED = "impact-speed/fcl-summary.csv"
DYNAMICS = "dynamics/dynamics.csv"
IMPACTS = "impacts/log.txt"
LONG_STEPS = DYNAMICS + "#long-steps"
SHORT_STEPS = DYNAMICS + "#short-steps"
SAMPLED = ("impact-sampled:samples=3", "impact-sampled", "impact-sampled:samples=30")


@functools.cache
def by_step(root, source):
    """The finished rows by scenario, frames a step and label."""
    return {(row["scenario"], int(row["step"]), row["label"]): row for row in csv_rows(root, source) if row["status"] == "ok"}


def median(row):
    return float(row["total_ns_median"])


def iterations(row):
    return " / ".join(f"{float(row[f'impact_iterations_{key}']):.0f}" for key in ("median", "p95"))


def questions(row):
    return f"{int(row['frames']):,}, {float(row['contacts']):.0f}"


def wrongs(row):
    """"; 2 missed, 1 open", or nothing."""
    found = [f"{float(row[key]):.0f} {name}" for key, name in
             (("missed", "missed"), ("false_contacts", "false"), ("impact_undecided", "open")) if float(row[key] or 0)]
    return "; " + ", ".join(found) if found else ""


def impact_table(root):
    yield ("| scenario, step | questions, impacts | `certified`: median, p95 in µs; iterations | `aabb-tree`: times; iterations | "
           "3 samples: times | 10 | 30 |")
    yield "| --- | ---: | ---: | ---: " + "| ---: " * len(SAMPLED) + "|"
    rows = by_step(root, SPEED)
    for (scenario, step, label), ours in rows.items():
        if label != "certified":
            continue
        times = [digits(float(ours[f"total_ns_{key}"]) / 1e3) for key in ("median", "p95")]
        cells = [f"{scenario} {step}", questions(ours), f"{', '.join(times)}; {iterations(ours)}{wrongs(ours)}"]
        for other in ("aabb-tree", *SAMPLED):
            row = rows[scenario, step, other]
            looked = f"; {iterations(row)}" if other == "aabb-tree" else ""
            cells.append(f"{digits(median(row) / median(ours))}{looked}{wrongs(row)}")
        yield f"| {' | '.join(cells)} |"


def long_questions(root, label):
    """Of a method in steps of 100 frames: the least and the largest time over that of certified, missed impacts, and all."""
    rows = by_step(root, SPEED)
    found = [(rows[scenario, step, label], ours) for (scenario, step, name), ours in rows.items() if (step, name) == (100, "certified")]
    shares = [median(row) / median(ours) for row, ours in found]
    missed, impacts = (sum(float(row[key]) for row, _ in found) for key in ("missed", "contacts"))
    return (*span(shares), missed, impacts)


def fcl_table(root):
    yield "| scenario, step | questions, impacts | `fcl-continuous`: median in ms | `certified`: median in µs |"
    yield "| --- | ---: | ---: | ---: |"
    rows = by_step(root, FCL_SPEED)
    for (scenario, step, label), row in rows.items():
        if label == "fcl-continuous":
            ours = rows[scenario, step, "certified"]
            yield (f"| {scenario} {step} | {questions(row)} | {digits(median(row) / 1e6)}{wrongs(row)} | "
                   f"{digits(median(ours) / 1e3)}{wrongs(ours)} |")


@functools.cache
def steps(root, within):
    """Rows of the closed loop in steps of some frames, by scenario and frames a step. within: "continuous", where impacts are
    found within a step, or "sampled", where contacts are looked for at its end."""
    return {(row["scenario"], int(row["step"])): row for row in csv_rows(root, DYNAMICS)
            if row["method"] == "certified" and row["within"] == within}


def counts(row):
    return ", ".join(f"{int(row[key]):,}" for key in ("approaches", "passes_through", "intersecting"))


def time_of_frame(row):
    return digits(float(row["query_ns"]) / 1e3 / int(row["step"]))


def steps_table(root, head, shown):
    """shown: by what stands in the first column, the scene and the frames a step."""
    yield (f"| {head} | continuous: approaches, pass, intersect | pushes | µs a frame | sampled: approaches, pass, intersect | "
           "µs a frame |")
    yield "| --- | ---: | ---: | ---: | ---: | ---: |"
    for name, key in shown.items():
        found, sampled = (steps(root, within)[key] for within in ("continuous", "sampled"))
        yield (f"| {name} | {counts(found)} | {found['floor_pushes']} | {time_of_frame(found)} | {counts(sampled)} | "
               f"{time_of_frame(sampled)} |")


def long_steps_table(root):
    return steps_table(root, "scene", {scene: (scene, step) for scene, step in steps(root, "continuous") if step == 30})


def short_steps_table(root):
    shown = {f"{scene} {step}": (scene, step) for scene in ("tt", "mv", "ww") for step in (1, 3, 10)}
    return steps_table(root, "scene, frames a step", shown)


def sums(root, within, *keys, least=1):
    """Of all scenes in steps of at least so many frames, the sums of some columns."""
    rows = [row for (_, step), row in steps(root, within).items() if step >= least]
    return [sum(int(row[key]) for row in rows) for key in keys]


def energy_drifts(root):
    """Of the loops in which impacts are found within steps: the median and the largest change of energy, relative to it."""
    drifts = [float(row["energy_drift"]) for row in steps(root, "continuous").values()]
    return (statistics.median(drifts), max(drifts))


def logged_impacts(root):
    """Of the last part of `make impacts`: all intervals, those with an impact, those that graze, and of these how many were
    said to graze and how many were undecided."""
    lines = {line[:10].strip(): line[10:].split() for line in file_of(root, IMPACTS).read_text().splitlines()[1:]}
    return [int(value) for value in (*lines["all"][:2], lines["grazing"][0], *lines["grazing"][6:8])]


def continuous_to_sampled(root, scene, step):
    """How many times as long a frame takes where impacts are found within steps of so many frames as where contacts
    are looked for in each frame."""
    return float(steps(root, "continuous")[scene, step]["query_ns"]) / step / float(steps(root, "sampled")[scene, 1]["query_ns"])
