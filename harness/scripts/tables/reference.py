"""The README's table of the accepted reference, and rows of that run."""
import functools
import json

from tables.number_text import exact_text, interval, size
from tables.records import by_method, file_of

SUMMARY = "reference/summary.json"


@functools.cache
def summary(root):
    """Rows of the reference run by scenario and label."""
    return by_method(json.loads(file_of(root, SUMMARY).read_text())["rows"], "label")


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


def reference_row(root, label, scenario="ww"):
    return summary(root)[scenario, label]


def times_of_particles(root, scenario):
    """The time of the certified query over that of the paper's method."""
    exact, paper = (reference_row(root, label, scenario)["total_ns"]["median"]
                    for label in ("certified", "particle-paper:n=5,start=fps"))
    return exact / paper
