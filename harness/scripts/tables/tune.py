"""A table of docs/peers.md: the best of many settings of each engine, from a run of `make tune`, and whether `make engines`
has it."""
import functools

from tables.engines import ENGINES, fastest, fastest_right_of, is_engine, time_of
from tables.number_text import digits
from tables.records import csv_rows, is_right

TUNE = "tune/summary.csv"
ORIENTED = ("fcl-obb", "fcl-rss", "fcl-obbrss", "fcl-kios")


@functools.cache
def settings(root):
    """The finished rows of engines of others, by scenario and method."""
    found = {}
    for row in csv_rows(root, TUNE):
        if row["status"] == "ok" and row["cache"] == "hot" and row["accounting"] == "charged" and is_engine(row["method"]):
            found.setdefault(row["scenario"], {}).setdefault(row["method"], []).append(row)
    return found


@functools.cache
def best(root, scenario):
    """Of each engine the fastest setting without a wrong answer, by method, the fastest engine first."""
    found = {method: fastest_right_of(rows, "median") for method, rows in settings(root)[scenario].items()}
    return dict(sorted(found.items(), key=lambda item: time_of(item[1], "median")))


@functools.cache
def asked(root):
    """The scenarios of `make engines`, and its settings on each."""
    found = {}
    for row in csv_rows(root, ENGINES):
        found.setdefault(row["scenario"], set()).add(row["label"])
    return found


def whether_asked(root, row):
    if row["scenario"] not in asked(root):
        return ""
    return "yes" if row["label"] in asked(root)[row["scenario"]] else "no"


def of_engine(root, row):
    """The cells of an engine's best setting."""
    rows = settings(root)[row["scenario"]][row["method"]]
    right = [other for other in rows if is_right(other)]
    time, slowest = time_of(row, "median"), max(time_of(other, "median") for other in right)
    wrong = f", {len(rows) - len(right)} wrong" if len(right) < len(rows) else ""
    star = " *" * (row is fastest(best(root, row["scenario"]).values(), "median"))
    return (f"`{row['scenario']}`", f"{len(rows)}{wrong}", f"`{row['label']}`", digits(time) + star, digits(slowest / time),
            whether_asked(root, row))


def tune_table(root):
    """A star marks the fastest of a scene."""
    yield "| scene | settings | best by the median | µs | slowest / best | in `make engines` |"
    yield "| --- | ---: | --- | ---: | ---: | --- |"
    for scenario in settings(root):
        for row in best(root, scenario).values():
            yield f"| {' | '.join(of_engine(root, row))} |"


def count_of_settings(root):
    return [sum(len(rows) for methods in settings(root).values() for rows in methods.values()), len(settings(root))]


def fastest_not_asked(root):
    """The scenes of `make engines` on which it does not have the fastest setting, as the end of a sentence."""
    first = [fastest(best(root, scenario).values(), "median") for scenario in settings(root)]
    missing = ", ".join(f"`{row['scenario']}`" for row in first if whether_asked(root, row) == "no")
    return [missing and f" but {missing}"]


def oriented_to_boxes(root, scenario):
    """How many times as long FCL's best oriented volume takes as its best axis-aligned boxes."""
    times = {method: time_of(row, "median") for method, row in best(root, scenario).items()}
    return min(times[method] for method in ORIENTED if method in times) / times["fcl-aabb"]
