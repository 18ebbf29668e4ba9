"""A table of docs/peers.md: the best of many settings of each engine, from a run of `make tune`, and whether `make engines`
has it."""
import functools

from engine_tables import ENGINES, fastest, is_engine, time_of
from number_text import digits
from records import csv_rows, wrong_verdicts

TUNE = "tune/summary.csv"
ORIENTED = ("fcl-obb", "fcl-rss", "fcl-obbrss", "fcl-kios")
LARGEST_ERROR = 1e-9  # of L: MOTE_EXACT_ERROR


def is_right(row):
    return not wrong_verdicts(row) and not float(row["error_max"] or 0) > LARGEST_ERROR


@functools.cache
def settings(root):
    """The finished rows of engines of others, by scenario and method."""
    found = {}
    for row in csv_rows(root, TUNE):
        if row["status"] == "ok" and row["cache"] == "hot" and row["accounting"] == "charged" and is_engine(row["method"]):
            found.setdefault(row["scenario"], {}).setdefault(row["method"], []).append(row)
    return found


def right_ones(rows):
    return [row for row in rows if is_right(row)]


def best(rows):
    return fastest(right_ones(rows), "median")


@functools.cache
def asked(root):
    """The scenarios and settings of `make engines`."""
    return {(row["scenario"], row["label"]) for row in csv_rows(root, ENGINES)}


def whether_asked(root, row):
    scenes = {scenario for scenario, _ in asked(root)}
    if row["scenario"] not in scenes:
        return ""
    return "yes" if (row["scenario"], row["label"]) in asked(root) else "no"


def of_engine(root, rows, is_fastest):
    right = right_ones(rows)
    row = fastest(right, "median")
    time = time_of(row, "median")
    slowest = max(time_of(other, "median") for other in right)
    wrong = f", {len(rows) - len(right)} wrong" if len(right) < len(rows) else ""
    return (f"{len(rows)}{wrong}", f"`{row['label']}`", digits(time) + " *" * is_fastest, digits(slowest / time), whether_asked(root, row))


def tune_table(root):
    """A star marks the fastest of a scene."""
    yield "| scene | settings | best by the median | µs | slowest / best | in `make engines` |"
    yield "| --- | ---: | --- | ---: | ---: | --- |"
    for scenario, methods in settings(root).items():
        order = sorted(methods.values(), key=lambda rows: time_of(best(rows), "median"))
        for rows in order:
            yield f"| {' | '.join((f'`{scenario}`', *of_engine(root, rows, rows is order[0])))} |"


def count_of_settings(root):
    return [sum(len(rows) for methods in settings(root).values() for rows in methods.values()), len(settings(root))]


def fastest_not_asked(root):
    """The scenes of `make engines` on which it does not have the fastest setting, in one text."""
    found = []
    for scenario, methods in settings(root).items():
        row = min((best(rows) for rows in methods.values()), key=lambda row: time_of(row, "median"))
        if whether_asked(root, row) == "no":
            found.append(f"`{scenario}`")
    return [", ".join(found)]


def oriented_to_boxes(root, *scenarios):
    """On each scene, how many times as long FCL's best oriented volume takes as its best axis-aligned boxes."""
    for scenario in scenarios:
        times = {method: time_of(best(rows), "median") for method, rows in settings(root)[scenario].items()}
        yield min(times[method] for method in ORIENTED if method in times) / times["fcl-aabb"]
